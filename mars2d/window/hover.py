"""What lies under the pointer, and what it is called."""

from __future__ import annotations

from math import dist, hypot
from typing import NamedTuple

import numpy as np
import shapely

from mars2d.addons.beacon import Beacon
from mars2d.addons.waypoints import Waypoints
from mars2d.core.plane import Point, lines_and_areas
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.window.selection import body_at

__all__ = ["Finder", "Hover"]


class Hover(NamedTuple):
    """What lies there: a body, by its index in `Scenario.bodies`, or something fixed; its name."""

    body: int | None
    name: str


class Finder:
    """Finds what lies at a point; keeps where the obstacles are from one search to the next."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self._scenario: Scenario | None = None

    def find(self, frame: Frame, point: Point, slack: float) -> Hover | None:
        """Return what lies at a point [m], the uppermost first, or None.

        slack: so far off its edge it is met as well, metres.
        """
        if frame.scenario is not self._scenario:
            self._learn(frame.scenario)
        body = self._body(frame, point, slack)
        if body is not None:
            rigid = frame.scenario.bodies[body]
            kind = "" if body < len(frame.scenario.robots) else f" ({rigid.kind})"
            return Hover(body, f"{rigid.name}{kind}")
        for name, place in _points(frame):
            if dist(place, point) <= 2 * slack:
                return Hover(None, name)
        found = self._obstacles.query(shapely.Point(point), "dwithin", slack)
        if len(found):
            k = int(found.min())
            kind = "wall" if len(self._outlines[k]) == 2 else "obstacle"
            return Hover(None, f"{kind} {k}")
        return None

    def _learn(self, scenario: Scenario) -> None:
        self._scenario = scenario
        self._outlines = scenario.obstacles
        self._obstacles = shapely.STRtree(lines_and_areas(self._outlines))
        bounds = (body.shape.bound for body in scenario.bodies)
        self._reach = np.array([hypot(*center) + radius for center, radius in bounds])

    def _body(self, frame: Frame, point: Point, slack: float) -> int | None:
        x, y = np.hstack([frame.pose[:2], frame.prop_pose[:2]])
        near = np.hypot(x - point[0], y - point[1]) <= self._reach + slack
        return body_at(frame, point, slack) if near.any() else None


def _points(frame: Frame) -> list[tuple[str, Point]]:
    """Return the beacons and waypoints with their names."""
    found: list[tuple[str, Point]] = []
    names = [robot.name for robot in frame.scenario.robots]
    for addon in frame.scenario.addons:
        if isinstance(addon, Beacon):
            found.append((f"beacon {addon.key}", addon.where(frame.time)))
        elif isinstance(addon, Waypoints):
            for robot, route in zip(names, addon.routes, strict=False):
                found += [(f"waypoint {k} of {robot}", place) for k, place in enumerate(route)]
    return found
