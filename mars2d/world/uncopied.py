"""What belongs to one run, and can't be copied."""

from __future__ import annotations

from typing import NoReturn

from mars2d.core.errors import InputError

__all__ = ["Uncopied"]


class Uncopied:
    """The base of a world: a copy would share half of it, and mix two runs."""

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        raise InputError(
            "a world can't be copied, pickled or sent to another process: make one more by "
            "World(world.scenario, control, world.seed), or use world.record"
        )
