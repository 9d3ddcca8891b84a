"""Which mutant is alive: each mutated function asks when it is called."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cached_property, wraps
from typing import Any

Function = Callable[..., Any]
MutantDict = dict[str, Any]

alive = os.environ.get("MUTANT", "")
"""The mutant of this process, as ``mars2d.core.plane.x_wrap__mutmut_3``; empty for none."""

called: set[str] = set()
"""The functions called since this was cleared, as ``mars2d.core.plane.x_wrap__mutmut``."""


def wrap_in_trampoline(mutants: MutantDict) -> Callable[[Function], Function]:
    """Return a decorator: the function becomes the mutant that is alive, else its original."""

    def decorate(function: Function) -> Function:
        @wraps(function)
        def trampoline(*args: Any, **kwargs: Any) -> Any:
            called.add(f"{function.__module__}.{list(mutants)[1].rpartition('_')[0]}")
            module, _, name = alive.rpartition(".")
            mine = module == function.__module__ and name in mutants
            return _function(mutants[name if mine else "_mutmut_orig"])(*args, **kwargs)

        return trampoline

    return decorate


def _function(made: Any) -> Function:
    if isinstance(made, property):
        return made.fget
    return made.func if isinstance(made, cached_property) else made
