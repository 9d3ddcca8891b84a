"""The surroundings of a world's robots: rays, points, colours and beacons, for the sensors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core import checks
from mars2d.core.errors import InputError
from mars2d.core.plane import Point
from mars2d.core.through import through
from mars2d.core.usercode import called

Float = NDArray[np.float64]
Int = NDArray[np.int64]

NOTHING = -(2**31)
"""The number of the body that a ray hits where it hits none; bodies are >= 0, obstacles < 0."""

WHITE = (1.0, 1.0, 1.0)
"""The colour of the floor where no add-on gives it one."""


class Surroundings:
    """Answers the questions of one world's sensors and add-ons. Points are (x, y) [m] in its frame.

    `ignore` is the index of the robot that asks: it never sees itself. Bodies are numbered robots
    first, then props; obstacle k is -1 - k. Raises InputError for numbers that are not finite.
    """

    def __init__(self, world: Any) -> None:
        """Take the state of the world."""
        self._world = world

    time: float = through("_world.time")
    """The simulated time, seconds."""
    sampling_time: float = through("_world.sampling_time")
    """The time between control steps, seconds."""
    pose: Float = through("_world.pose")
    """The poses of all robots, (3, n)."""
    prop_pose: Float = through("_world.prop_pose")
    """The poses of all props, (3, p)."""
    addons: Any = through("_world.addons")
    """The add-ons, as attributes by their names: an experiment may add things to measure."""
    driven: Sequence[tuple[float, Float]] = through("_world.driven")
    """The twists that the drives asked for in the last control step: (seconds, (3, n)) in turn.

    A twist is (forward [m/s], left [m/s], spin [rad/s]), linear velocities along the axes of the
    robot or, for a drive whose `frame` is "world", of the world. Empty at the start.
    """

    # -- rays and points -------------------------------------------------------------------

    def distance(self, point: Point, limit: float, ignore: int) -> float:
        """Return the distance to the nearest surface, metres; inf when beyond `limit`.

        Negative inside a robot.
        """
        _check_look("point", point, "limit", limit)
        return float(self._world.engine.space.distance(point, limit, ignore))

    def nearby(self, point: Point, limit: float, ignore: int) -> Iterator[Point]:
        """Yield, for each surface at most `limit` away, its nearest point (x, y)."""
        _check_look("point", point, "limit", limit)
        found: Iterator[Point] = self._world.engine.space.nearby(point, limit, ignore)
        return found

    def ray(self, start: Point, angle: float, length: float, ignore: int) -> float:
        """Return how far a ray goes until the first surface, metres; inf when nothing is hit."""
        _check_look("start", start, "length", length)
        if not isfinite(angle):
            raise InputError(f"angle = {angle}: expected a finite number")
        return float(self._world.engine.space.length(start, angle, length, ignore))

    def scans(self, poses: Float, bearings: Float, length: ArrayLike, ignore: ArrayLike) -> Float:
        """Return how far rays of robots go, (m, k) metres; inf where nothing is hit.

        poses: where each one's rays start, and which way it looks (3, m). bearings: of the rays
        from there (k,) rad. length: of all rays, or (k,). ignore: the robots that ask (m,). A ray
        that starts inside a robot or prop goes 0 m. Obstacles are outlines: within one of them a
        ray goes on to its edge.
        """
        _check_fans(poses, bearings, length)
        found: Float = self._world.engine.space.distances(poses, bearings, length, ignore)
        return found

    def sights(
        self, poses: Float, bearings: Float, length: ArrayLike, ignore: ArrayLike
    ) -> tuple[Float, Int]:
        """Return how far rays go, as `scans`, and which body each hits, (m, k): NOTHING if none."""
        _check_fans(poses, bearings, length)
        space = self._world.engine.space
        found: tuple[Float, Int] = space.sight(poses, bearings, length, ignore, NOTHING)
        return found

    def hidden(
        self, start: Point, points: Float, bodies: ArrayLike, ignore: int
    ) -> NDArray[np.bool_]:
        """Return whether something stands between `start` and points (k, 2).

        bodies: (k,) or one: the body that each point belongs to, which does not hide it, or
        NOTHING.
        """
        return np.asarray(self._world.engine.space.hidden(start, points, bodies, ignore))

    # -- looks and add-ons --------------------------------------------------------------------

    def color(self, body: int) -> str:
        """Return the colour of a body or obstacle, ``#rrggbb``."""
        return str(self._world.scenario.color_of(body))

    @property
    def beacons(self) -> Mapping[str, Point]:
        """Where the beacons are now, by name. Raises LawError for what is no point."""
        found: dict[str, Point] = {}
        for addon in vars(self.addons).values():
            with called(f"add-on {addon.key!r}", addon.beacons):
                for name, place in addon.beacons().items():
                    found[str(name)] = checks.point(f"beacon {name!r}", place)
        return found

    def ground(self, point: Point) -> tuple[float, float, float]:
        """Return the colour of the floor at a point: red, green and blue from 0 to 1."""
        for addon in reversed(vars(self.addons).values()):
            with called(f"add-on {addon.key!r}", addon.ground):
                color: tuple[float, float, float] | None = addon.ground(point)
            if color is not None:
                return color
        return WHITE


def _check_look(what: str, point: Point, how_far: str, limit: float) -> None:
    """Raise InputError for a point or length that is not finite, which would find nothing."""
    if not (isfinite(point[0]) and isfinite(point[1])):
        raise InputError(f"{what} = {point}: expected finite numbers")
    if not limit >= 0:  # nor is NaN
        raise InputError(f"{how_far} = {limit}: expected at least 0 m")


def _check_fans(poses: Float, bearings: Float, length: ArrayLike) -> None:
    """Raise InputError for poses or bearings that are not finite, and for negative lengths."""
    for name, values in (("poses", poses), ("bearings", bearings)):
        if not np.isfinite(values).all():
            raise InputError(f"{name} = {np.asarray(values)}: expected finite numbers")
    if not np.greater_equal(length, 0).all():
        raise InputError(f"length = {np.asarray(length)}: expected at least 0 m")
