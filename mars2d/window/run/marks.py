"""Marks of hands on bodies: rings and words, and where a point of a body is."""

from __future__ import annotations

from math import cos, hypot, sin
from typing import Literal

import numpy as np

from mars2d.bodies.rigid import Rigid, Triple
from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.output.layers.bodies import bounding_circle
from mars2d.output.layers.forces import FORCE
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Float, Frame

GOOD, BAD = LIGHT.selected, LIGHT.error.ink
HALO = "#ffffff"
LABEL = 13.0
"""The size of labels, points."""


def draw_words(scene: Scene, camera: Camera, point: Point, text: str, color: str = FORCE) -> None:
    """Write a text above a point [m]."""
    place = point[0], point[1] + 9 / camera.scale
    scene.text(place, text, color=color, size=LABEL, anchor="above", halo=HALO)


def draw_dot(scene: Scene, point: Point, color: str) -> None:
    """Draw an end of a line of a hand."""
    scene.circle(point, 0.0, fill=color, stroke=HALO, width=1.5, pixels=3.5)


def draw_ring(
    scene: Scene, frame: Frame, body: int, color: str, width: float, far: float = 6.0
) -> None:
    """Draw a ring round a body; width: of its line, far: its least radius, points."""
    center, radius = _circle(frame, body)
    for stroke, more in ((HALO, 2.0), (color, 0.0)):
        scene.circle(center, radius, stroke=stroke, width=width + more, pixels=far)


def draw_label(
    scene: Scene,
    frame: Frame,
    camera: Camera,
    body: int,
    text: str,
    color: str,
    side: Literal["above", "below"] = "above",
) -> None:
    """Write a text above or below the ring round a body."""
    (x, y), radius = _circle(frame, body)
    off = radius + 12 / camera.scale
    place = x, y + off if side == "above" else y - off
    scene.text(place, text, color=color, size=LABEL, anchor=side, halo=HALO)


def _circle(frame: Frame, body: int) -> tuple[Float, float]:
    pose = np.array(frame.body_pose(body))
    return bounding_circle(frame.scenario.bodies[body].shape, pose)


# -- points of bodies -------------------------------------------------------------------------


def local_point(frame: Frame, body: int, point: Point) -> Point:
    """Return a point [m] in a body's own frame."""
    x, y, theta = frame.body_pose(body)
    dx, dy, c, s = point[0] - x, point[1] - y, cos(theta), sin(theta)
    return c * dx + s * dy, c * dy - s * dx


def world_point(pose: Triple, local: Point) -> Point:
    """Return where a point of a body's own frame [m] is."""
    c, s = cos(pose[2]), sin(pose[2])
    return pose[0] + c * local[0] - s * local[1], pose[1] + s * local[0] + c * local[1]


def within(rigid: Rigid, point: Point) -> Point:
    """Return the point of a body's bounding circle nearest to a point, both in its frame."""
    (x, y), radius = rigid.shape.bound
    dx, dy = point[0] - x, point[1] - y
    share = min(1.0, radius / max(hypot(dx, dy), 1e-300))
    return x + share * dx, y + share * dy
