"""The surroundings of a world's robots: rays, points, colours and beacons, for the sensors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.addons.base import Addon, Color
from mars2d.bodies.colors import OBSTACLE, prop_colors
from mars2d.core.errors import InputError
from mars2d.core.plane import Point
from mars2d.core.through import through
from mars2d.core.usercode import called
from mars2d.physics.space import Space
from mars2d.sensors.base import NOTHING
from mars2d.world.state import Addons, State

Float = NDArray[np.float64]
Int = NDArray[np.int64]

WHITE = (1.0, 1.0, 1.0)
"""The colour of the floor where no add-on gives it one."""


class Around:
    """The Surroundings of one world's sensors; see `mars2d.sensors.Surroundings`."""

    def __init__(self, world: State) -> None:
        self._world = world
        self.renew()

    def renew(self) -> None:
        """Drop all caches, after bodies, obstacles or add-ons were changed."""
        for name in ("_colors", "_addons"):
            vars(self).pop(name, None)

    @property
    def _space(self) -> Space:
        return self._world.engine.space

    time: float = through("_world.time")
    """The simulated time, seconds."""
    sampling_time: float = through("_world.sampling_time")
    """The time between control steps, seconds."""
    pose: Float = through("_world.pose")
    """The poses of all robots, (3, n)."""
    prop_pose: Float = through("_world.prop_pose")
    """The poses of all props, (3, p)."""
    driven: Sequence[tuple[float, Float]] = through("_world.driven")
    """The twists that the drives asked for in the last control step."""
    addons: Addons = through("_world.addons")
    """The add-ons by name, as ``world.addons``."""

    # -- rays and points -------------------------------------------------------------------

    def distance(self, point: Point, limit: float, ignore: int) -> float:
        """Return the distance to the nearest surface, metres; inf beyond `limit`."""
        _check_look("point", point, "limit", limit)
        return self._space.distance(point, limit, ignore)

    def nearby(self, point: Point, limit: float, ignore: int) -> Iterator[Point]:
        """Yield, for each surface at most `limit` away, its nearest point (x, y)."""
        _check_look("point", point, "limit", limit)
        return self._space.nearby(point, limit, ignore)

    def ray(self, start: Point, angle: float, length: float, ignore: int) -> float:
        """Return the length of a ray to the first surface, metres; inf if none is hit."""
        _check_look("start", start, "length", length)
        if not isfinite(angle):
            raise InputError(f"angle = {angle}: expected a finite number")
        return self._space.length(start, angle, length, ignore)

    def scans(self, poses: Float, bearings: Float, length: ArrayLike, ignore: ArrayLike) -> Float:
        """Return the lengths (m, k) of rays from poses (3, m) at bearings (k,), metres."""
        _check_fans(poses, bearings, length)
        return self._space.distances(poses, bearings, length, ignore)

    def sights(
        self, poses: Float, bearings: Float, length: ArrayLike, ignore: ArrayLike
    ) -> tuple[Float, Int]:
        """Return the lengths of rays as `scans`, and the body that each hits, (m, k)."""
        _check_fans(poses, bearings, length)
        return self._space.sight(poses, bearings, length, ignore, NOTHING)

    def hidden(
        self, start: Point, points: Float, bodies: ArrayLike, ignore: int
    ) -> NDArray[np.bool_]:
        """Return whether something stands between `start` and points (k, 2)."""
        return self._space.hidden(start, points, bodies, ignore)

    # -- looks -------------------------------------------------------------------------------

    def color(self, body: int) -> str:
        """Return the colour of a body or obstacle, ``#rrggbb``."""
        return OBSTACLE if body < 0 else self._colors[body]

    @cached_property
    def _colors(self) -> tuple[str, ...]:
        scenario = self._world.scenario
        return (*scenario.colors, *prop_colors(scenario.props))

    # -- add-ons ----------------------------------------------------------------

    @cached_property
    def _addons(self) -> tuple[Addon, ...]:
        return tuple(vars(self._world.addons).values())

    @property
    def beacons(self) -> Mapping[str, Point]:
        """The positions of the beacons now, by name."""
        found: dict[str, Point] = {}
        for addon in self._addons:
            with called(f"add-on {addon.key!r}", addon.beacons):
                found |= addon.beacons()
        return found

    def ground(self, point: Point) -> Color:
        """Return the colour of the floor at a point: red, green and blue from 0 to 1."""
        for addon in reversed(self._addons):
            with called(f"add-on {addon.key!r}", addon.ground):
                color = addon.ground(point)
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
