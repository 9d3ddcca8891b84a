"""What lies under the pointer, and which body is selected."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from math import dist, hypot
from typing import NamedTuple

import numpy as np
import shapely

from mars2d.core.plane import Point, lines_and_areas
from mars2d.core.scene import Scene
from mars2d.geometry.shapes import Piece
from mars2d.output.layers.bodies import bounding_circle
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Float, Frame
from mars2d.scenario.scenario import Scenario


class Hover(NamedTuple):
    """Something under the pointer.

    body: its index in `Scenario.bodies`, None for anything that is not a body.
    """

    body: int | None
    name: str


class Finder:
    """Finds the thing at a point; keeps an index of the obstacles between two searches."""

    def __init__(self) -> None:
        """Start without a scenario."""
        self._scenario: Scenario | None = None

    def find(self, frame: Frame, point: Point, slack: float) -> Hover | None:
        """Return the uppermost thing at a point [m], or None.

        slack: how far beside its edge a thing is still met, metres.
        """
        if frame.scenario is not self._scenario:
            self._scenario, self._outlines = frame.scenario, frame.scenario.obstacles
            self._obstacles = shapely.STRtree(lines_and_areas(self._outlines))
            bounds = (body.shape.bound for body in frame.scenario.bodies)
            self._reach = np.array([hypot(*center) + radius for center, radius in bounds])
        x, y = frame.all_poses[:2]
        near = np.hypot(x - point[0], y - point[1]) <= self._reach + slack
        body = body_at(frame, point, slack) if near.any() else None
        if body is not None:
            rigid = frame.scenario.bodies[body]
            kind = "" if body < len(frame.scenario.robots) else f" ({rigid.kind})"
            return Hover(body, f"{rigid.name}{kind}")
        points = (point for addon in frame.scenario.addons for point in addon.named_points(frame))
        for name, place in points:
            if dist(place, point) <= 2 * slack:
                return Hover(None, name)
        found = self._obstacles.query(shapely.Point(point), "dwithin", slack)
        if len(found):
            k = int(found.min())
            kind = "wall" if len(self._outlines[k]) == 2 else "obstacle"
            return Hover(None, f"{kind} {k}")
        return None


def body_at(
    frame: Frame, point: tuple[float, float], slack: float, but: Collection[int] = ()
) -> int | None:
    """Return the body at a point, or None; robots lie above props.

    Bodies are indices of `Scenario.bodies`. slack: how far beside its edge one is hit, metres. but:
    bodies that are looked through.
    """
    poses = frame.all_poses
    n = frame.pose.shape[1]
    order = [*reversed(range(n)), *reversed(range(n, poses.shape[1]))]
    for i in order:
        if i in but:
            continue
        x, y, theta = poses[:, i].tolist()
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


def selection_mark(frame: Frame, body: int) -> Scene:
    """Return the ring round a selected body."""
    scene = Scene()
    pose = np.array(frame.body_pose(body))
    center, radius = bounding_circle(frame.scenario.bodies[body].shape, pose)
    for color, width in (("#ffffff", 4.5), (LIGHT.selected, 2.5)):
        scene.circle(center, radius, stroke=color, width=width, pixels=10.0)
    return scene
