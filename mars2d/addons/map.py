"""Obstacles from lists of vertices."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from mars2d.addons.base import Addon
from mars2d.core.checks import outlines, polylines
from mars2d.core.description import entry, wrong
from mars2d.core.errors import InputError
from mars2d.core.files import file_beside
from mars2d.core.plane import Outline


class Map(Addon):
    """Obstacles from lists of vertices [m]: two vertices make a wall, more a closed polygon.

    >>> Map([[(0, 0), (1, 0)], [(2, 2), (3, 2), (3, 3)]]).obstacles()[0]
    ((0.0, 0.0), (1.0, 0.0))

    Walls of several corners that are not to be closed are `walls`; each piece is an obstacle.

    >>> len(Map(walls=[[(0, 0), (4, 0), (4, 3)]]).obstacles())
    2

    `Map.from_file` reads them from drawings, occupancy grids and images.

    Concave outlines stay concave. By default a contact has the product of both surfaces' friction
    and restitution: with 1 and 1 here, those of the robot decide.
    """

    outlines: Sequence[Outline] = entry(
        default=None, check=outlines, optional=True, unit="m", kw_only=False,
        doc="the obstacles",
    )  # fmt: skip
    walls: Sequence[Outline] = entry(
        default=(), check=polylines, unit="m", doc="walls of two or more vertices, not closed"
    )

    def _validate(self) -> None:
        super()._validate()
        if self.outlines is None:
            if not self.walls:
                raise InputError(
                    "Map: expected outlines or walls, such as Map([[(0, 0), (1, 0), (1, 1)]]) or "
                    "Map(walls=[[(0, 0), (4, 0), (4, 3)]])"
                )
            object.__setattr__(self, "outlines", ())

    def obstacles(self) -> tuple[Outline, ...]:
        """Return the outlines, and the walls piece by piece."""
        return (*self.outlines, *(piece for wall in self.walls for piece in pairwise(wall)))

    @classmethod
    def from_file(
        cls,
        path: str | Path | Map,
        *,
        layers: str | Sequence[str] | None = None,
        unit: str | float | None = None,
        resolution: float | None = None,
        tolerance: float = 0.02,
        at: Sequence[float] | None = None,
    ) -> Map:
        """Return the map in a file: a drawing, an occupancy grid of ROS, an image, GeoJSON.

        path: a relative one is looked for beside the file that calls this, then in the current
        folder; a Map is returned as it is. layers: names or patterns such as ``*WALL*``, a list
        or one text with commas. unit: ``mm``, ``cm``, ``m``, ``in``, ``ft`` or metres, in place of
        what the file says. resolution: metres per pixel of an image. tolerance: how far corners
        and curves may be off, to have fewer corners [m]. at: (x, y) [m] of the lower left corner
        of what is read. Raises InputError, which names the file and what was expected.
        """
        if isinstance(path, Map):
            return path
        if not isinstance(path, (str, Path)):
            raise wrong("Map.from_file(path)", path, "the name of a file, such as 'plan.dxf'")
        from mars2d.addons import maps

        caller = Path(sys._getframe(1).f_code.co_filename)
        file = file_beside(Path(path), caller, "a map", maps.SUFFIXES)
        drawing = maps.read(
            file, layers=layers, unit=unit, resolution=resolution, at=at, tolerance=tolerance
        )
        found = maps.obstacles(drawing)
        return cls(found.outlines, walls=found.walls)
