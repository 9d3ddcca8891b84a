"""What is drawn over a draft (marks, remarks, handles of the selection), and drags of handles."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import copysign, cos, degrees, hypot, pi, radians, sin
from typing import Literal

import numpy as np

from mars2d.bodies.props.base import Prop
from mars2d.bodies.props.rectangles import Box
from mars2d.core.plane import Outline, Point, edges_of
from mars2d.core.scene import Scene, faded
from mars2d.output.raster.theme import LIGHT
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.item import Item, Motion, angle_of, tidy
from mars2d.window.editor.readout import size_of, stretch, turned
from mars2d.window.editor.tool import Drag

REACH = 9.0
"""The radius in which a handle is hit, points."""

MARK, PAPER = LIGHT.selected, LIGHT.paper

IDLE, IDLE_SIZE = LIGHT.waiting.ink, 12.0
RED = LIGHT.error.ink

MIN_RING, MAX_RING = 30.0, 150.0
"""The radius of the ring on the screen, points."""

NOTCH = 15.0
"""The steps of a turn with Shift, degrees."""

MIN_SIDE = 0.01
"""The shortest side of a rectangle that is drawn, metres."""


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
    points = [p for item in items for p in draft.corners(item) or [draft.place(item)]]
    x, y = np.mean(points, axis=0).tolist()  # stays where it is while they turn about it
    center = tidy(x), tidy(y)
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
    if item.kind != "prop" or body is None or draft.value(item).side_lengths is None:
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


def draw_selected(draft: Draft, items: Iterable[Item], scene: Scene) -> None:
    """Draw the outlines of selected items."""
    for item in items:
        _outline(draft, item, scene, PAPER, 4.5)
        _outline(draft, item, scene, MARK, 2.2)


def draw_culprits(draft: Draft, items: Iterable[Item], scene: Scene) -> None:
    """Draw faulty items in red."""
    for item in items:
        if draft.holds(item):
            _outline(draft, item, scene, RED, 3.0, faded(RED, 0.3))


def draw_remarks(draft: Draft, idle: Mapping[int, str], scene: Scene) -> None:
    """Write below each robot what it lacks to be moved, and whether it starts at random."""
    for i, robot in enumerate(draft.robots):
        words = ["at random"] if draft.starts_at_random(Item("robot", i)) else []
        if i in idle:
            words.append("no law" if idle[i] == "a law" else f"lacks {idle[i]}")
        (x, y), radius = robot.rigid.bound
        text, below = ", ".join(words), (x, y - radius)
        if text:
            scene.text(below, text, color=IDLE, size=IDLE_SIZE, anchor="below", halo=PAPER)


def _outline(
    draft: Draft, item: Item, scene: Scene, stroke: str, width: float, fill: str | None = None
) -> None:
    corners, body = draft.corners(item), draft.body(item)
    if body is not None:
        for rim in body.shape.rims:
            points = [body.to_world(point) for point in rim.points]
            if rim.radius:
                scene.circle(points[0], rim.radius, stroke=stroke, fill=fill, width=width)
            else:
                scene.polygon(points, stroke=stroke, fill=fill, width=width)
    elif corners is None:
        scene.circle(draft.place(item), 0.0, stroke=stroke, width=width, pixels=9.0)
    elif item.kind == "wall" or len(corners) == 2:
        scene.line(corners, stroke=stroke, width=width)
    else:
        inside = None if item.kind == "workspace" else fill
        scene.polygon(corners, stroke=stroke, fill=inside, width=width)


# -- drags ------------------------------------------------------------------------------------


def moving(desk: Desk, grabbed: Item, start: Point) -> Drag:
    """Move the selection; the grabbed item's own point snaps to the grid."""
    draft, items, (x, y) = desk.draft, desk.selection, desk.draft.place(grabbed)

    def to(point: Point, _: bool) -> Draft:
        goal = desk.snapped((x + point[0] - start[0], y + point[1] - start[1]))
        return draft.moved(items, Motion(by=(goal[0] - x, goal[1] - y)))

    return Drag(to)


def turning(desk: Desk, ring: Ring) -> Drag:
    """Turn the selection about the middle of its ring, with Shift in notches."""
    draft, items, only = desk.draft, desk.selection, desk.only
    one = only is not None and draft.pose(only) is not None
    zero = 0.0 if one else ring.heading  # from where notches are counted

    def to(point: Point, shift: bool) -> Draft:
        step = NOTCH if shift else 1.0 if desk.snaps else 0.1
        wanted = degrees(angle_of(ring.center, point) - zero)
        angle = radians(round(wanted / step) * step) - (ring.heading - zero)
        return draft.moved(items, Motion(angle, ring.center)) if abs(angle) > 1e-12 else draft

    return Drag(to, lambda: "" if only is None else turned(desk.draft, only))


def cornering(desk: Desk, item: Item, number: int, *, new: bool = False) -> Drag:
    """Move a corner of an outline, a wall or the workspace; new: one that is added after it."""
    draft, k = desk.draft, number + 1 if new else number
    kept = (draft.corners(item) or ())[number:k]

    def to(point: Point, _: bool) -> Draft:
        return draft.with_corner(item, number, *kept, desk.snapped(point))

    def remark() -> str:
        corners = desk.draft.corners(item) or ()
        edges = [(k - 1, k)] if k or item.kind != "wall" else []
        edges += [(k, (k + 1) % len(corners))] if k + 1 < len(corners) or not edges else []
        return "   ".join(stretch(corners[a], corners[b]) for a, b in edges)

    return Drag(to, remark, k)


def sizing(desk: Desk, item: Item, number: int) -> Drag:
    """Resize a rectangular prop by a corner; the opposite corner stays."""
    draft, fixed = desk.draft, size_corners(desk.draft, item)[(number + 2) % 4]

    def to(point: Point, _: bool) -> Draft:
        goal = desk.snapped(point)
        return draft.with_members([item], lambda prop: spanned(prop, fixed, goal))

    return Drag(to, lambda: size_of(desk.draft, item))


def spanned(prop: Prop, a: Point, b: Point) -> Prop:
    """Return a rectangular prop between two opposite corners, with the same heading."""
    x, y, theta = prop.pose
    c, s = cos(theta), sin(theta)
    dx, dy = b[0] - a[0], b[1] - a[1]
    along, across = c * dx + s * dy, c * dy - s * dx
    length, width = (tidy(max(abs(side), MIN_SIDE)) for side in (along, across))
    along, across = copysign(length / 2, along), copysign(width / 2, across)
    x, y = a[0] + c * along - s * across, a[1] + s * along + c * across
    return prop.with_side_lengths(length, width).replace(pose=(tidy(x), tidy(y), theta))


def sized(prop: Prop, a: Point, b: Point) -> Prop:
    """Return a prop that is drawn from a to b: a disc about a, a box, or a bar along the way."""
    length, heading = hypot(b[0] - a[0], b[1] - a[1]), angle_of(a, b)
    if prop.side_lengths is None:
        return prop.replace(diameter=tidy(2 * length), pose=(*a, 0.0))
    if isinstance(prop, Box):
        return spanned(prop, a, b) if a[0] != b[0] and a[1] != b[1] else prop.at(*a)
    middle = tidy((a[0] + b[0]) / 2), tidy((a[1] + b[1]) / 2)
    return prop.replace(length=tidy(length), pose=(*middle, tidy(heading)))
