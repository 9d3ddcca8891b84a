"""The handles of the selection: corners, the dots between them, a ring that turns it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import atan2, cos, hypot, pi, sin
from typing import Literal

from mars2d.core.plane import Outline, Point, edges_of
from mars2d.core.scene import Scene
from mars2d.output.raster.theme import LIGHT
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.item import Item

__all__ = [
    "MARK",
    "PAPER",
    "Handle",
    "Ring",
    "angle_of",
    "draw_handles",
    "handle_at",
    "handles",
    "ring_of",
    "size_corners",
]

REACH = 9.0
"""The radius in which a handle is hit, points."""

MARK, PAPER = LIGHT.selected, LIGHT.paper

MIN_RING, MAX_RING = 30.0, 150.0
"""The radius of the ring on the screen, points."""


@dataclass(frozen=True)
class Handle:
    """A handle at a point [m]; number: the index of its corner, or of the corner before a dot."""

    kind: Literal["corner", "dot", "size", "turn"]
    number: int
    point: Point


@dataclass(frozen=True)
class Ring:
    """The ring round the selection, metres; heading: the direction of its handle, radians."""

    center: Point
    radius: float
    heading: float

    @property
    def handle(self) -> Point:
        """The position of its handle."""
        x, y = self.center
        return x + self.radius * cos(self.heading), y + self.radius * sin(self.heading)


def ring_of(desk: Desk) -> Ring | None:
    """Return the ring, None if the selection can't be turned."""
    draft = desk.draft
    items = [item for item in desk.selection if item.kind != "workspace"]
    pose = None if desk.only is None else draft.pose(desk.only)
    turns = [item for item in items if item.kind not in ("waypoint", "beacon")]
    if pose is None and not turns and len(items) < 2:
        return None
    xmin, xmax, ymin, ymax = draft.bounds(items)
    center = (xmin + xmax) / 2, (ymin + ymax) / 2
    radius = hypot(xmax - xmin, ymax - ymin) / 2
    heading = pi / 2
    if pose is not None:
        center, heading, radius = pose[:2], pose[2], max(xmax - xmin, ymax - ymin) / 2
    low, high = desk.metres(MIN_RING), desk.metres(MAX_RING)
    return Ring(center, min(max(radius + desk.metres(16.0), low), high), heading)


def handles(desk: Desk) -> list[Handle]:
    """Return the handles of the selection, the uppermost last."""
    found = []
    ring, item = ring_of(desk), desk.only
    if ring is not None:
        found.append(Handle("turn", 0, ring.handle))
    if item is None:
        return found
    corners = desk.draft.corners(item)
    if corners is not None:
        found += [Handle("dot", k, point) for k, point in _dots(desk, item, corners)]
        found += [Handle("corner", k, point) for k, point in enumerate(corners)]
    found += [Handle("size", k, point) for k, point in enumerate(size_corners(desk.draft, item))]
    return found


def _dots(desk: Desk, item: Item, corners: Outline) -> list[tuple[int, Point]]:
    """Return the middles of the edges that are long enough for a dot."""
    edges = edges_of(corners)
    if item.kind == "wall":
        edges = list(pairwise(corners))
    return [
        (k, ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2))
        for k, (a, b) in enumerate(edges)
        if not desk.near(a, b, 4 * REACH)
    ]


def size_corners(draft: Draft, item: Item) -> list[Point]:
    """Return a rectangular prop's corners, counter-clockwise from the right rear; else none."""
    body = draft.body(item)
    if item.kind != "prop" or body is None or draft.props[item.number].side_lengths is None:
        return []
    return [body.to_world(point) for point in body.shape.rims[0].points]


def handle_at(desk: Desk, point: Point) -> Handle | None:
    """Return the uppermost handle at a point [m]."""
    hit = (h for h in reversed(handles(desk)) if desk.near(point, h.point, REACH))
    return next(hit, None)


def draw_handles(desk: Desk, scene: Scene) -> None:
    """Draw the ring and all handles."""
    color, paper = MARK, PAPER
    ring = ring_of(desk)
    if ring is not None:
        scene.circle(ring.center, ring.radius, stroke=paper, width=3.5)
        scene.circle(ring.center, ring.radius, stroke=color, width=1.5)
    for handle in handles(desk):
        if handle.kind == "turn":
            scene.circle(handle.point, 0.0, fill=color, stroke=paper, width=2.0, pixels=7.0)
        elif handle.kind == "dot":
            scene.circle(handle.point, 0.0, fill=paper, stroke=color, width=1.2, pixels=3.2)
        else:
            chosen = handle.kind == "corner" and handle.number == desk.corner
            fill, size = (color, 6.5) if chosen else (paper, 5.0)
            half = desk.metres(size)
            x, y = handle.point
            square = [(x + a * half, y + b * half) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            scene.polygon(square, fill=fill, stroke=color, width=2.0)


def angle_of(center: Point, point: Point) -> float:
    """Return the direction from one point to another, radians."""
    return atan2(point[1] - center[1], point[0] - center[0])
