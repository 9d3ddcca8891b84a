"""A laser scanner: the distances along many beams."""

from __future__ import annotations

from functools import cached_property
from math import pi
from typing import Any, ClassVar

import numpy as np

from mars2d.core.arithmetic import cosines_sines
from mars2d.core.description import integer, number
from mars2d.core.quantity import DISTANCE, Quantity
from mars2d.core.scene import Scene, faded
from mars2d.geometry.bearings import beam_angles
from mars2d.sensors.base import Fan, Float, Scanner, sight_angle
from mars2d.sensors.surroundings import Surroundings


class RangeFinder(Scanner):
    """Measures the distance to the first surface along evenly spaced beams: a laser scanner.

    The reading is an array (beams,), metres from the sensor; inf where nothing is within range. The
    first beam points half the field of view to the right of the heading, the last one as much to
    the left; of a full circle it is left out. A single beam points ahead.

    >>> RangeFinder(beams=4).angles.round(2).tolist()
    [-3.14, -1.57, 0.0, 1.57]

    Source: S. Thrun, W. Burgard, D. Fox, Probabilistic Robotics, section 6.3 (2005).
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (DISTANCE,)

    beams: int = integer(default=180, low=1, high=100_000, doc="the number of beams")
    range: float = number(default=5.0, above=0, high=1e6, unit="m", doc="its range")
    field_of_view: float = sight_angle(default=2 * pi, doc="the angle from first to last beam")

    @cached_property
    def angles(self) -> Float:
        """The bearings of the beams (beams,): radians from the sensor's heading."""
        return beam_angles(self.beams, self.field_of_view)

    def scan(self, poses: Float, robots: list[int], world: Surroundings) -> Float:
        """Return the distances (m, beams) to the first surfaces."""
        return world.scans(poses, self.angles, self.range, robots)

    @property
    def fan(self) -> Fan:
        """Its beams."""
        closed = self.field_of_view >= 2 * pi and self.beams > 2
        return Fan(self.angles, self.range, closed=closed)

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw the area that the beams sweep, and a dot where one has hit something."""
        x, y, theta = self.placed(pose).tolist()
        angles = theta + self.angles
        far = np.minimum(reading, self.range)
        c, s = cosines_sines(angles)
        ends = np.column_stack([x + far * c, y + far * s])
        area = ends if self.fan.closed else np.vstack([[x, y], ends])
        scene.polygon(area, fill=faded(color, 0.07))
        hits = ends[np.isfinite(reading)]
        if len(hits):
            scene.line(hits, stroke=faded(color, 0.9), style=".")
