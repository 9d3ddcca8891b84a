"""A laser scanner: the distances along many beams."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import pi
from typing import Any, ClassVar

import numpy as np

from mars2d.core.arithmetic import cosines_sines
from mars2d.core.description import integer, number
from mars2d.core.interfaces import RobotLike
from mars2d.core.quantity import DISTANCE, Quantity
from mars2d.core.scene import Scene, faded
from mars2d.geometry.bearings import beam_angles
from mars2d.sensors.base import Fan, Float, Scanner, Surroundings, sight_angle


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

    def read_all(
        self,
        robots: Sequence[RobotLike],
        world: Surroundings,
        rngs: Sequence[np.random.Generator],  # noqa: ARG002
    ) -> Float:
        """Return the distances (m, beams) to the first surfaces."""
        mine = [robot.index for robot in robots]
        return world.scans(self.placed(world.pose[:, mine]), self.angles, self.range, mine)

    @property
    def fan(self) -> Fan:
        """Its beams."""
        closed = self.field_of_view >= 2 * pi and self.beams > 2
        return Fan(self.angles, self.range, closed=closed)

    def sign(self, scene: Scene, color: str) -> str:
        """Draw a piece of the free area, and where it ends."""
        scene.sector((-9.0, 0.0, 0.0), 16.0, 0.9, fill=faded(color, 0.15))
        c, s = cosines_sines(np.array([-0.3, 0.0, 0.3]))
        for place in np.column_stack([16 * c - 9, 16 * s]):
            scene.circle(place, 0.0, fill=color, pixels=1.5)
        return "a laser's hit"

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
