"""Obstacles from lists of vertices."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from mars2d.addons.base import Addon
from mars2d.checks import outlines, polylines
from mars2d.description import entry
from mars2d.errors import InputError
from mars2d.geometry import Outline

__all__ = ["Map"]


def _outlines(name: str, value: object) -> Sequence[Outline] | None:
    return None if value is None else outlines(name, value)


class Map(Addon):
    """Obstacles from lists of vertices [m]: two vertices make a wall, more a closed polygon.

    >>> Map([[(0, 0), (1, 0)], [(2, 2), (3, 2), (3, 3)]]).obstacles()[0]
    ((0.0, 0.0), (1.0, 0.0))

    Walls of several corners that are not to be closed are `walls`; each piece is an obstacle.

    >>> len(Map(walls=[[(0, 0), (4, 0), (4, 3)]]).obstacles())
    2

    Concave outlines stay concave. A contact has the product of both surfaces' friction and
    restitution: with 1 and 1 here, those of the robot decide.
    """

    outlines: Sequence[Outline] = entry(
        default=None, check=_outlines, unit="m", kw_only=False,
        doc="the obstacles: two vertices make a wall, more a closed polygon",
    )  # fmt: skip
    walls: Sequence[Outline] = entry(
        default=(), check=polylines, unit="m", doc="walls of two or more vertices, not closed"
    )

    def _validate(self) -> None:
        super()._validate()
        if self.outlines is None:
            if not self.walls:
                raise InputError(
                    "Map: expected outlines or walls, as Map([[(0, 0), (1, 0), (1, 1)]]) or "
                    "Map(walls=[[(0, 0), (4, 0), (4, 3)]])"
                )
            object.__setattr__(self, "outlines", ())

    def obstacles(self) -> tuple[Outline, ...]:
        """Return the outlines, and the walls piece by piece."""
        return (*self.outlines, *(piece for wall in self.walls for piece in pairwise(wall)))
