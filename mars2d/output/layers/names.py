"""The names of robots and props, beside them."""

from __future__ import annotations

from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene, Text
from mars2d.output.layers.bodies import INK
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

__all__ = ["draw_name", "names"]

Float = NDArray[np.float64]

SIZE, SMALL = 13.0, 11.0  # points
HALO = "#ffffff"

MANY_BODIES = 20
"""Among more bodies, names are smaller, and a robot named robot12 by default is just 12."""


def names(frame: Frame) -> Scene:
    """Return a label above each body."""
    scene = Scene()
    for i, pose in enumerate(np.hstack([frame.pose, frame.prop_pose]).T):
        draw_name(scene, frame.scenario, i, pose)
    return scene


def draw_name(scene: Scene, scenario: Scenario, body: int, pose: Float) -> None:
    """Write the name of a body above it, at a pose (3,)."""
    bodies, (x, y, theta) = scenario.bodies, pose.tolist()
    crowd, name = len(bodies) > MANY_BODIES, str(bodies[body].name)
    (ahead, left), radius = bodies[body].shape.bound
    place = (
        x + ahead * cos(theta) - left * sin(theta),
        y + ahead * sin(theta) + left * cos(theta) + radius,
    )
    if crowd and name == f"robot{body}":
        name = str(body)
    scene.shapes.append(Text(place, name, INK, SMALL if crowd else SIZE, "above", HALO))
