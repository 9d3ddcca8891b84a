"""What belongs to one run, and can't be copied."""

from __future__ import annotations

from copy import deepcopy
from typing import Any, NoReturn, Self

from mars2d.core.errors import InputError

FORKING = "a fork of a world"
"""The key of a memo of `deepcopy` with which a whole world is copied."""


class Uncopied:
    """The base of a world: a copy would share half of it, and mix two runs."""

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        raise InputError(
            "a world can't be copied, pickled or sent to another process: world.fork() goes on "
            "from here, World(world.scenario, control, world.seed) starts again, and world.record "
            "is data"
        )

    def __deepcopy__(self, memo: dict[Any, Any]) -> Self:
        """Copy this as a part of a whole world, or raise InputError."""
        if FORKING not in memo:
            self.__reduce_ex__(4)
        copied = memo[id(self)] = object.__new__(type(self))
        vars(copied).update({name: deepcopy(value, memo) for name, value in vars(self).items()})
        return copied
