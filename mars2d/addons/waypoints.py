"""Waypoints: the points that robots are to reach, one after the other."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.addons.base import Addon
from mars2d.core.arithmetic import norms
from mars2d.core.checks import POINT, items_of, lists_of, point
from mars2d.core.description import accepts, entry, number, wrong
from mars2d.core.errors import InputError, LawError, counted
from mars2d.core.interfaces import FrameLike, WorldLike
from mars2d.core.plane import Outline, Point, outside_polygon
from mars2d.core.scene import Scene, faded

PALE = 0.35
"""The opacity of waypoints that are reached."""


@accepts({"type": "array", "items": {"type": "array", "items": POINT}})
def _routes(name: str, value: object) -> tuple[Outline, ...]:
    """Check a list of lists of points, of which some but not all may be empty."""
    routes = tuple(
        tuple(
            point(f"{each}[{k}]", place)
            for k, place in enumerate(items_of(each, route, "a list of points (x, y) in metres"))
        )
        for each, route in lists_of(name, value, "routes, one for each robot")
    )
    if not any(routes):
        raise wrong(name, value, "one list of points for each robot, and at least one point")
    return routes


class Waypoints(Addon):
    """The waypoints of each robot, to be reached in order.

    >>> Waypoints([[(1, 0), (2, 0)]]).passed([[(0, 0)], [(1, 0.1)], [(1.5, 0)]])
    (1,)

    Route k is that of robot k; it may be empty or missing. A waypoint is reached at the first
    control step at which the robot is no farther from it than `tolerance`, after all those before.
    Laws ask ``world.addons.waypoints`` for `goal`, `arrived` and `reached`. It moves no robot.
    """

    routes: Sequence[Outline] = entry(
        check=_routes, unit="m", kw_only=False, doc="the points (x, y) of each robot's route"
    )
    tolerance: float = number(
        default=0.3,
        above=0,
        high=1e6,
        unit="m",
        doc="distance at which a waypoint counts as reached",
    )

    def passed(self, path: ArrayLike) -> tuple[int, ...]:
        """Return the number of waypoints of each route that are reached on a path.

        path: (T, n, 2), the positions of all robots at all control steps [m].
        """
        positions = np.asarray(path, dtype=float)
        return tuple(self._along(route, positions[:, i]) for i, route in enumerate(self.routes))

    def _along(self, route: Outline, positions: NDArray[np.float64]) -> int:
        """Return the number of points of a route that are reached along positions (T, 2)."""
        row = 0
        for k, (x, y) in enumerate(route):
            near = norms(positions[row:, 0] - x, positions[row:, 1] - y) <= self.tolerance
            if not near.any():
                return k
            row += int(near.argmax())
        return len(route)

    def of(self, frame: FrameLike) -> tuple[int, ...]:
        """Return the number of waypoints of each route that are reached at a frame."""
        pose = np.concatenate([frame.path, frame.pose[None]])
        return self.passed(pose[:, :2].swapaxes(1, 2))

    @property
    def reached(self) -> tuple[int, ...]:
        """The number of waypoints of each route that are reached so far; in a scenario, 0."""
        found: tuple[int, ...] = self.__dict__.get("_reached", (0,) * len(self.routes))
        return found

    def goal(self, robot: int, frame: FrameLike | None = None) -> Point:
        """Return the waypoint (x, y) [m] that a robot, by its index, is to go to now.

        The last one stays the goal once it is reached. frame: another instant than now. Raises
        LawError for a robot that has no waypoints.
        """
        route = self._route(robot)
        if not route:
            raise LawError(f"{self.key}: robot {robot} has no waypoints to go to")
        reached = self.reached if frame is None else self.of(frame)
        return route[min(reached[robot], len(route) - 1)]

    def arrived(self, robot: int) -> bool:
        """Return whether a robot, by its index, has reached its last waypoint; or has none."""
        route = self._route(robot)
        return not route or self.reached[robot] == len(route)

    def _route(self, robot: int) -> Outline:
        """Return the route of a robot, which is empty beyond the last one that is given."""
        if robot < 0:
            raise LawError(f"{self.key}: there is no robot {robot}; the first is 0")
        return self.routes[robot] if robot < len(self.routes) else ()

    def on_start(self, world: WorldLike) -> None:
        """Raise InputError if the routes do not fit the robots and the workspace."""
        robots = world.scenario.robots
        if len(self.routes) > len(robots):
            raise InputError(
                f"Waypoints.routes has {counted(len(self.routes), 'route')}, but there "
                f"{'is' if len(robots) == 1 else 'are'} {counted(len(robots), 'robot')}"
            )
        self._reached = self.reached
        workspace = world.scenario.workspace
        if workspace is None or world.scenario.on_exit == "ignore":
            return
        for i, route in enumerate(self.routes):
            x, y = np.array(route, dtype=float).reshape(-1, 2).T
            for k in np.flatnonzero(outside_polygon(x, y, np.array(workspace))).tolist():
                raise wrong(f"Waypoints.routes[{i}][{k}]", route[k], "a point of the workspace")

    def on_step(self, world: WorldLike) -> None:
        """Note the waypoints that have been reached."""
        positions = world.position.T[None]
        self._reached = tuple(
            done + self._along(route[done:], positions[:, i])
            for i, (route, done) in enumerate(zip(self.routes, self._reached, strict=True))
        )

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Draw each route as a dotted line with its points; reached ones are paler."""
        starts, colors = frame.scenario.initial_pose.T, frame.scenario.colors
        for i, (route, done) in enumerate(zip(self.routes, self.of(frame), strict=True)):
            points, color = [(starts[i, 0], starts[i, 1]), *route], colors[i]
            for k, leg in enumerate(pairwise(points)):
                ink = faded(color, PALE if k < done else 1.0)
                scene.line(leg, stroke=ink, width=1.2, style=":")
                scene.circle(leg[1], 0.0, fill=ink, pixels=3.5)
            if route:
                ink = faded(color, PALE if done == len(route) else 1.0)
                scene.circle(route[-1], self.tolerance, stroke=ink, width=1.2)
