"""The verbs of ``mars2d``, one module each.

The module `run` is the verb ``mars2d run``. A verb's module has a function `add_arguments(parser)`
and a function `execute(arguments)`, whose docstring is the verb's help.
"""

from importlib import import_module

__all__ = ["VERBS"]

NAMES = (
    "demo",
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
    "paper",
    "bench",
    "doctor",
)
"""The names of the verbs, in the order in which the help lists them."""

VERBS = {name: import_module(f"{__name__}.{name}") for name in NAMES}
"""The verbs' modules by name."""
