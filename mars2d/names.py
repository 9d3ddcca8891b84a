"""The names of robots and props, beside them."""

from __future__ import annotations

import numpy as np

from mars2d.forces import bounding_circle
from mars2d.frame import Frame
from mars2d.looks import INK
from mars2d.scene import Scene

__all__ = ["names"]

SIZE, SMALL = 13.0, 11.0  # points
HALO = "#ffffff"

FEW = 20
"""Among more bodies names are smaller, and a robot called robot12 by default is only 12."""


def names(frame: Frame) -> Scene:
    """Return a label above each body."""
    scene, bodies = Scene(), frame.scenario.bodies
    poses = np.hstack([frame.pose, frame.prop_pose])
    crowd = len(bodies) > FEW
    for i, body in enumerate(bodies):
        center, radius = bounding_circle(body.shape, poses[:, i])
        text = str(i) if crowd and body.name == f"robot{i}" else str(body.name)
        size = SMALL if crowd else SIZE
        place = center[0], center[1] + radius
        scene.text(place, text, color=INK, size=size, anchor="above", halo=HALO)
    return scene
