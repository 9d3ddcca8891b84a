"""One item of a draft, and how items are moved."""

from __future__ import annotations

from math import atan2, cos, sin
from typing import Literal, NamedTuple

from mars2d.core.plane import Point

Kind = Literal["robot", "prop", "outline", "wall", "route", "beacon", "workspace", "joint"]


class Item(NamedTuple):
    """An item of a draft.

    number: its index among the items of its kind; of a route, that of its robot.
    """

    kind: Kind
    number: int = 0


class Motion(NamedTuple):
    """A turn by `angle` [rad] about the point `about`, then a shift by `by` [m]."""

    angle: float = 0.0
    about: Point = (0.0, 0.0)
    by: Point = (0.0, 0.0)

    def point(self, point: Point) -> Point:
        """Return a point after the motion."""
        if not self.angle:
            return tidy(point[0] + self.by[0]), tidy(point[1] + self.by[1])
        (x, y), c, s = self.about, cos(self.angle), sin(self.angle)
        dx, dy = point[0] - x, point[1] - y
        return tidy(x + c * dx - s * dy + self.by[0]), tidy(y + s * dx + c * dy + self.by[1])

    def pose(self, pose: tuple[float, float, float]) -> tuple[float, float, float]:
        """Return a pose after the motion, its heading in (-pi, pi] if it turns."""
        heading = pose[2]
        if self.angle:
            turned = heading + self.angle
            heading = tidy(atan2(sin(turned), cos(turned)))
        return (*self.point(pose[:2]), heading)


def tidy(value: float) -> float:
    """Return a length or angle rounded to nine decimals, without errors of rounding."""
    return round(value, 9) + 0.0


def angle_of(center: Point, point: Point) -> float:
    """Return the direction from one point to another, radians."""
    return atan2(point[1] - center[1], point[0] - center[0])
