"""Which parts of the picture are shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from mars2d.scenario.animation import Animation

__all__ = ["Layers"]


@dataclass(frozen=True, slots=True)
class Layers:
    """What may be switched on and off while watching."""

    grid: bool = True
    trails: bool = True
    sensors: bool = True
    messages: bool = True
    forces: bool = False
    theory: bool = False
    addons: bool = True
    names: bool = False
    velocities: bool = False
    neighbours: bool = False

    @classmethod
    def of(cls, animation: Animation, *, sensors: bool = True) -> Self:
        """Return what an experiment starts with."""
        return cls(
            grid=animation.grid,
            trails=animation.wake,
            sensors=sensors,
            forces=animation.forces,
            theory=animation.theory,
        )
