"""A camera with one line of pixels: the colours of the things in view."""

from __future__ import annotations

from functools import cached_property
from itertools import groupby
from math import isnan, nan, pi
from typing import Any, ClassVar

import numpy as np

from mars2d.core.arithmetic import cosines_sines
from mars2d.core.description import integer, number
from mars2d.core.quantity import COLOR, Quantity
from mars2d.core.scene import Scene, color_of, faded, rgb
from mars2d.geometry.bearings import beam_angles
from mars2d.sensors.base import Float, Scanner, sight_angle
from mars2d.sensors.surroundings import NOTHING, Surroundings

NEAR, FAR = 0.07, 0.085
"""The line of pixels is drawn between these shares of the range."""


class LineCamera(Scanner):
    """Sees the colours of robots, props and obstacles in a line of pixels, over an angle.

    The reading is an array (pixels, 3) of red, green and blue, from 0 to 1; nan where nothing is
    within range. The first pixel looks half the field of view to the right of the heading. All
    things are lit evenly and hide what is behind them.
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (COLOR,)

    pixels: int = integer(default=64, low=1, high=100_000, doc="the number of pixels")
    range: float = number(default=10.0, above=0, high=1e6, unit="m", doc="its range")
    field_of_view: float = sight_angle(default=pi / 2, doc="the angle from first to last pixel")

    @cached_property
    def angles(self) -> Float:
        """The bearings of the pixels (pixels,): radians from the sensor's heading."""
        return beam_angles(self.pixels, self.field_of_view)

    def scan(self, poses: Float, robots: list[int], world: Surroundings) -> Float:
        """Return the colours (m, pixels, 3) that the pixels see."""
        _, bodies = world.sights(poses, self.angles, self.range, robots)
        seen, which = np.unique(bodies, return_inverse=True)
        missing = (nan, nan, nan)
        colors = [missing if b == NOTHING else rgb(world.color(b)) for b in seen.tolist()]
        return np.array(colors)[which.reshape(bodies.shape)]

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:
        """Draw the pixels as a strip of colours in front of the camera."""
        placed = self.placed(pose)
        x, y, theta = placed.tolist()
        near, far = NEAR * self.range, FAR * self.range
        scene.sector(placed, near, self.field_of_view, fill=faded(color, 0.1))
        step = self.field_of_view / max(self.pixels - (self.field_of_view < 2 * pi), 1)
        seen = np.asarray(reading).tolist()
        names = [None if any(map(isnan, pixel)) else color_of(pixel) for pixel in seen]
        for name, pixels in groupby(range(len(names)), names.__getitem__):
            if name is not None:
                angles = theta + self.angles[[*pixels]]
                arc = np.concatenate([angles - step / 2, angles[-1:] + step / 2])
                rim = np.column_stack(cosines_sines(arc))
                strip = np.vstack([near * rim, far * rim[::-1]]) + np.array([x, y])
                scene.polygon(strip, fill=name)
