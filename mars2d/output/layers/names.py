"""The names of robots and props, beside them."""

from __future__ import annotations

from math import cos, sin

import numpy as np

from mars2d.core.scene import Scene, Text
from mars2d.output.layers.bodies import INK
from mars2d.record.frame import Frame

__all__ = ["names"]

SIZE, SMALL = 13.0, 11.0  # points
HALO = "#ffffff"

FEW = 20
"""Among more bodies names are smaller, and a robot called robot12 by default is only 12."""


def names(frame: Frame) -> Scene:
    """Return a label above each body."""
    scene, bodies = Scene(), frame.scenario.bodies
    poses = np.hstack([frame.pose, frame.prop_pose]).T.tolist()
    crowd = len(bodies) > FEW
    for i, (body, (x, y, theta)) in enumerate(zip(bodies, poses, strict=True)):
        (ahead, left), radius = body.shape.bound
        place = (
            x + ahead * cos(theta) - left * sin(theta),
            y + ahead * sin(theta) + left * cos(theta) + radius,
        )
        text = str(i) if crowd and body.name == f"robot{i}" else str(body.name)
        size = SMALL if crowd else SIZE
        scene.shapes.append(Text(place, text, INK, size, "above", HALO))
    return scene
