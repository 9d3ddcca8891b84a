"""A ring of sonars: the distance to the nearest thing in each of several cones."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from math import inf, pi
from typing import Any, ClassVar

import numpy as np

from mars2d.core.arithmetic import cosine_sine, cosines_sines, norms
from mars2d.core.description import integer, number
from mars2d.core.plane import WITHIN, Point, up_to
from mars2d.core.quantity import DISTANCE, Quantity
from mars2d.core.scene import Scene, arc, faded
from mars2d.geometry.bearings import beam_angles
from mars2d.sensors.base import Fan, Float, Scanner, sight_angle
from mars2d.sensors.surroundings import Surroundings


class SonarRing(Scanner):
    """Measures the distance to the nearest surface in each of several cones: a ring of sonars.

    The reading is an array (sonars,), metres from the sensor; inf where nothing is within range.
    The cones' axes are spaced as the beams of a RangeFinder. The nearest point of each surface
    counts, so nothing slips through a cone.

    >>> SonarRing(sonars=3, field_of_view=3.0).angles.tolist()
    [-1.5, 0.0, 1.5]

    Source: R. Siegwart, I. Nourbakhsh, Introduction to Autonomous Mobile Robots, section 4.1.6
    (2004).
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (DISTANCE,)

    sonars: int = integer(default=8, low=1, high=10_000, doc="the number of sonars")
    cone: float = sight_angle(default=0.35, doc="the angle of each cone")
    range: float = number(default=3.0, above=0, high=1e6, unit="m", doc="its range")
    field_of_view: float = sight_angle(default=2 * pi, doc="the angle from first to last axis")

    @cached_property
    def angles(self) -> Float:
        """The bearings of the cones' axes (sonars,): radians from the sensor's heading."""
        return beam_angles(self.sonars, self.field_of_view)

    def scan(self, poses: Float, robots: list[int], world: Surroundings) -> Float:
        """Return the distances (m, sonars) to the nearest surfaces."""
        half = WITHIN * self.cone / 2
        # All surfaces are convex pieces: their point nearest to us within a cone is either the
        # nearest of all, or lies where an edge of the cone first meets them.
        edges = np.concatenate([self.angles - half, self.angles + half])
        rays = world.scans(poses, edges, self.range, robots)
        rays = rays.reshape(len(robots), 2, -1).min(axis=1)
        nearest = [
            self._nearest(x, y, theta, world.nearby((x, y), self.range, robot))
            for robot, (x, y, theta) in zip(robots, poses.T.tolist(), strict=True)
        ]
        return up_to(np.minimum(rays, nearest), self.range)

    def _nearest(self, x: float, y: float, theta: float, points: Iterator[Point]) -> Float:
        """Return the distances (sonars,) of the nearest points in the cones; inf where none is."""
        axes = theta + self.angles
        near = np.array(list(points)).reshape(-1, 2)
        dx, dy = near[:, :1] - x, near[:, 1:] - y
        distance = norms(dx, dy)
        c, s = cosines_sines(axes)
        inside = dx * c + dy * s >= distance * cosine_sine(WITHIN * self.cone / 2)[0]
        return np.asarray(np.where(inside, distance, inf).min(axis=0, initial=inf))

    @property
    def fan(self) -> Fan:
        """Its cones."""
        return Fan(self.angles, self.range, self.cone)

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw each cone as far as it is free, and an arc where it ends at something."""
        x, y, theta = self.placed(pose).tolist()
        for angle, distance in zip(theta + self.angles, np.asarray(reading).tolist(), strict=True):
            far = min(distance, self.range)
            scene.sector((x, y, angle), far, self.cone, fill=faded(color, 0.1))
            if distance <= self.range:
                scene.line(arc((x, y, angle), far, self.cone), stroke=faded(color, 0.9), width=2.0)
