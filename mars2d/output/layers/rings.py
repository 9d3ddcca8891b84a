"""Rings round robots that are so small in their workspace that they would hardly be seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene, faded
from mars2d.scenario.scenario import Scenario

SMALL = 0.012
"""A robot is small if its diameter is less than this share of the workspace's longer side."""

RING = 9.0
"""The radius of a ring, points. It lies below its robot, so that it is hidden where one is near."""


def has_ring(scenario: Scenario, body: int) -> bool:
    """Return whether a body has a ring: an index of `Scenario.bodies`."""
    if body >= len(scenario.robots) or not scenario.animation.show_real_shape:
        return False
    xmin, xmax, ymin, ymax = scenario.bounds
    return 2 * scenario.robots[body].radius < SMALL * max(xmax - xmin, ymax - ymin)


def place_ring(scene: Scene, scenario: Scenario, body: int, pose: NDArray[np.float64]) -> None:
    """Draw the ring of a body at a pose (3,), if it is a small robot; body: in `bodies`."""
    if has_ring(scenario, body):
        color = scenario.colors[body]
        scene.circle(
            pose[:2], 0.0, fill=faded(color, 0.2), stroke=faded(color, 0.8), width=1.3, pixels=RING
        )
