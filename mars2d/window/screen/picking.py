"""Which body lies under the pointer, and which is selected."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

import numpy as np

from mars2d.geometry.shapes import Piece
from mars2d.record.frame import Float, Frame


class Selection:
    """The selected body, an index of `Scenario.bodies`; None for none."""

    def __init__(self, body: int | None = None) -> None:
        """Start with a body, or with none."""
        self.body = body


def body_at(frame: Frame, point: tuple[float, float], slack: float) -> int | None:
    """Return the body at a point, or None; robots lie above props.

    Bodies are indices of `Scenario.bodies`. slack: how far beside its edge one is hit, metres.
    """
    poses = frame.all_poses
    n = frame.pose.shape[1]
    order = [*reversed(range(n)), *reversed(range(n, poses.shape[1]))]
    for i in order:
        x, y, theta = poses[:, i].tolist()
        center, radius = frame.scenario.bodies[i].shape.bound
        far = hypot(x - point[0], y - point[1]) > hypot(*center) + radius + slack
        if far:
            continue
        c, s = np.cos(theta), np.sin(theta)
        dx, dy = point[0] - x, point[1] - y
        local = np.array([c * dx + s * dy, c * dy - s * dx])
        if any(_distance(piece, local) <= slack for piece in frame.scenario.bodies[i].shape.pieces):
            return i
    return None


def _distance(piece: Piece, point: Float) -> float:
    """Return an upper bound of a point's distance to a convex piece, metres; negative inside."""
    ring = np.array(piece.vertices)
    if len(ring) == 1:
        return float(np.hypot(*(point - ring[0]))) - piece.radius
    edges = np.roll(ring, -1, axis=0) - ring
    outwards = np.column_stack([edges[:, 1], -edges[:, 0]]) / np.hypot(*edges.T)[:, None]
    return float(((point - ring) * outwards).sum(axis=1).max())


def next_body(frame: Frame, body: int | None) -> int | None:
    """Return the body after another in the order robots, props, None, and from the start again."""
    following = 0 if body is None else body + 1
    return following if following < len(frame.scenario.bodies) else None


def sensed_by(frame: Frame, body: int | None) -> Frame:
    """Return a frame with only the readings of the selected body, or all if it has none."""
    if body is None:
        return frame
    own = {
        name: [(i, reading) for i, reading in readings if i == body]
        for name, readings in frame.readings.items()
    }
    return replace(frame, readings=own) if any(own.values()) else frame
