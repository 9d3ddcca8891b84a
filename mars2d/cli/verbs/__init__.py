"""The verbs of ``mars2d``, one module each.

The module `run` is the verb ``mars2d run``. A verb's module has a function `add_arguments(parser)`
and a function `execute(arguments)`, whose docstring is the verb's help.
"""

from collections.abc import Iterator, Mapping
from importlib import import_module
from types import ModuleType

__all__ = ["VERBS"]

NAMES = (
    "demo",
    "new",
    "copy",
    "run",
    "play",
    "edit",
    "compare",
    "replay",
    "plot",
    "sweep",
    "tournament",
    "list",
    "check",
    "schema",
    "paper",
    "bench",
    "doctor",
    "completion",
)
"""The names of the verbs, in the order in which the help lists them."""


class _Verbs(Mapping[str, ModuleType]):
    """Imports a verb's module when it is asked for: a run needs nothing of all others."""

    def __getitem__(self, name: str) -> ModuleType:
        if name not in NAMES:
            raise KeyError(name)
        return import_module(f"{__name__}.{name}")

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)

    def __len__(self) -> int:
        return len(NAMES)


VERBS = _Verbs()
"""The verbs' modules by name."""
