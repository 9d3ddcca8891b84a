"""Environments for learners: gymnasium for one robot, PettingZoo for several."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mars2d.rl.environment import Environment
    from mars2d.rl.parallel import ParallelEnvironment

__all__ = ["Environment", "ParallelEnvironment"]

_PLACES = {
    "Environment": "mars2d.rl.environment",
    "ParallelEnvironment": "mars2d.rl.parallel",
}
"""Imported when first asked for: gymnasium imports this package to learn its environments."""


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_PLACES[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
