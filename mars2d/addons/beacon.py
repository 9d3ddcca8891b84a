"""Beacons: lamps that stand or move, for the sensor of the same name."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from itertools import accumulate, pairwise

from mars2d.addons.base import Addon
from mars2d.core import checks
from mars2d.core.arithmetic import norm
from mars2d.core.description import entry, flag, number
from mars2d.core.errors import InputError
from mars2d.core.interfaces import FrameLike, WorldLike
from mars2d.core.plane import Outline, Point
from mars2d.core.scene import Scene, color, faded


class Beacon(Addon):
    """A lamp that robots find with the sensor Beacon. It stands still, or moves along a path.

    >>> Beacon(path=[(0, 0), (2, 0), (2, 1)], speed=0.5).where(5.0)
    (2.0, 0.5)

    Its name is that of the add-on. It is no obstacle. Give `at`, or else `path` and `speed`: it
    starts at the first point of the path, goes to the next, and from the last one back to the
    first, again and again. Two points are a way there and back. With ``closed=False`` it goes along
    the path once, and stays at its last point.
    """

    at: Point | None = entry(
        default=None, check=checks.point, optional=True, unit="m", kw_only=False,
        doc="its position",
    )  # fmt: skip
    path: Outline | None = entry(
        default=None, check=checks.line, optional=True, unit="m", doc="the corners of its path"
    )
    speed: float | None = number(
        default=None, above=0, high=1e3, unit="m/s", optional=True, doc="its speed along the path"
    )
    closed: bool = flag(
        default=True,
        doc="whether it goes on from the path's end to its start",
    )
    color: str = entry(default="#e8c500", check=color, doc="its colour, for pictures only")

    def _validate(self) -> None:
        super()._validate()
        if (self.at is None) == (self.path is None):
            raise InputError(
                "Beacon: expected where it stands, such as at=(1, 2), or its path, such as "
                "path=[(0, 0), (2, 0)], speed=0.5"
            )
        if (self.path is None) != (self.speed is None):
            raise InputError("Beacon: a `path` needs a `speed` [m/s] along it, and a speed a path")

    def where(self, time: float) -> Point:
        """Return where it is at a time [s]: (x, y) in metres."""
        if self.path is None or self.speed is None:
            assert self.at is not None
            return self.at
        corners = self._way(self.path)
        sides = [norm(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(corners)]
        ends = [0.0, *accumulate(sides)]
        gone = self.speed * time
        if not self.closed and gone >= ends[-1]:
            return corners[-1]
        gone %= ends[-1]
        k = min(bisect_right(ends, gone) - 1, len(sides) - 1)
        (ax, ay), (bx, by) = corners[k], corners[k + 1]
        share = (gone - ends[k]) / sides[k]
        return ax + share * (bx - ax), ay + share * (by - ay)

    def _way(self, path: Outline) -> Outline:
        """Return the corners of one round; a closed path ends with its first corner."""
        ring = self.closed and path[0] != path[-1]
        return (*path, path[0]) if ring else path

    @property
    def position(self) -> Point:
        """Where it is now: (x, y) in metres. In a scenario, where it starts."""
        world = self.__dict__.get("_world")
        return self.where(0.0 if world is None else world.time)

    def beacons(self) -> Mapping[str, Point]:
        """Return where it is now, by its name."""
        return {self.key: self.position}

    def on_start(self, world: WorldLike) -> None:
        """Take the world's clock."""
        self._world = world

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Draw a lamp with its name, and its path."""
        if self.path is not None:
            way = self._way(self.path) if len(self.path) > 2 else self.path
            scene.line(way, stroke=faded(self.color, 0.6), width=1.0, style=":")
        here = self.where(frame.time)
        scene.circle(here, 0.0, fill=faded(self.color, 0.3), pixels=9.0)
        scene.circle(here, 0.0, fill=self.color, stroke="#444444", width=1.0, pixels=4.5)
        scene.text((here[0], here[1]), f"{self.key}\n", size=10.0, anchor="above", halo="#ffffff")
