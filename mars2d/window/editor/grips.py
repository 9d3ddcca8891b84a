"""What of the selection can be dragged: its ring, corners, the dots between them, sides."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from math import copysign, cos, degrees, hypot, pi, radians, sin
from typing import NamedTuple

import numpy as np
import shapely

from mars2d.bodies.props.base import Prop
from mars2d.bodies.props.rectangles import Box
from mars2d.core.plane import Point, edges_of
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft, Item, Motion, angle_of, tidy

REACH = 9.0
"""The radius in which a handle is hit, points."""

MIN_RING, MAX_RING = 30.0, 150.0
"""The radius of the ring on the screen, points."""

NOTCH = 15.0
"""The steps of a turn with Shift, degrees."""

MIN_SIDE = 0.01
"""The shortest side of a rectangle that is drawn, metres."""


class Grip(NamedTuple):
    """Something to drag.

    to: returns the draft with the pointer dragged to a point [m]. point: where its handle is, or
    where the drag begins, metres. look: "ring", "dot" or "square" of the handle, or "band" of the
    rectangle that is drawn. corner: the index of the corner that it moves, if any. clicked: the
    item that a mere click selects. at_once: whether a mere click has the effect, too. center: of
    the ring, metres.
    """

    to: Callable[[Point], Draft]
    point: Point
    look: str = ""
    corner: int | None = None
    clicked: Item | None = None
    at_once: bool = False
    center: Point = (0.0, 0.0)


def grips(desk: Desk) -> list[Grip]:
    """Return what has a handle, the uppermost last."""
    ring, item = ring_of(desk), desk.only
    found = [] if ring is None else [ring]
    if item is None:
        return found
    corners, line = desk.draft.corners(item), desk.draft.is_line(item)
    edges = [*pairwise(corners)] if line or not corners else edges_of(corners)
    dots = [
        _cornering(desk, item, k, ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), new=True)
        for k, (a, b) in enumerate(edges)
        if not desk.near(a, b, 4 * REACH)
    ]
    squares = [_cornering(desk, item, k, point) for k, point in enumerate(corners)]
    return [*found, *dots, *squares, *_sides(desk, item)]


def grip_at(desk: Desk, point: Point) -> Grip | None:
    """Return the uppermost at a point [m]."""
    hit = (grip for grip in reversed(grips(desk)) if desk.near(point, grip.point, REACH))
    return next(hit, None)


def moving(desk: Desk, grabbed: Item, start: Point) -> Grip:
    """Move the selection; the grabbed item's own point snaps to the grid."""
    draft, items, (x, y) = desk.draft, desk.selection, desk.draft.place(grabbed)

    def to(point: Point) -> Draft:
        goal = desk.snapped((x + point[0] - start[0], y + point[1] - start[1]))
        return draft.moved(items, Motion(by=(goal[0] - x, goal[1] - y)))

    return Grip(to, start, clicked=None if desk.shift else grabbed)


def banding(desk: Desk, start: Point, kept: tuple[Item, ...]) -> Grip:
    """Select the items within a rectangle, with those that are kept."""
    draft = desk.draft

    def to(point: Point) -> Draft:
        desk.select([*kept, *desk.items_within(start, point)])
        return draft

    return Grip(to, start, "band")


def ring_of(desk: Desk) -> Grip | None:
    """Turn the selection about the middle of its ring, with Shift in notches; None if it can't."""
    draft, only, selection = desk.draft, desk.only, desk.selection
    items = [item for item in selection if item.kind != "workspace"]
    points = [p for item in items for p in draft.corners(item) or [draft.place(item)]]
    body = None if only is None else draft.body(only)
    if body is None and len(points) < 2:
        return None
    if body is not None:
        (x, y, heading), reach = body.pose, body.bound[1]
    else:
        xmin, ymin, xmax, ymax = shapely.total_bounds([draft.shapes[item] for item in items])
        x, y = map(tidy, np.mean(points, axis=0).tolist())  # stays while they turn about it
        reach, heading = hypot(xmax - xmin, ymax - ymin) / 2, pi / 2
    low, high, above = (desk.metres(points) for points in (MIN_RING, MAX_RING, 16.0))
    radius = min(max(reach + above, low), high)

    def to(point: Point) -> Draft:
        step = NOTCH if desk.shift else 1.0 if desk.snaps else 0.1
        wanted = degrees(angle_of((x, y), point))
        angle = radians(round(wanted / step) * step) - heading
        return draft.moved(selection, Motion(angle, (x, y))) if abs(angle) > 1e-12 else draft

    handle = x + radius * cos(heading), y + radius * sin(heading)
    return Grip(to, handle, "ring", center=(x, y))


def _cornering(desk: Desk, item: Item, number: int, at: Point, *, new: bool = False) -> Grip:
    """Move a corner of an outline, a wall or the workspace; new: one that is added after it."""
    draft, k = desk.draft, number + new
    before, after = draft.corners(item)[:k], draft.corners(item)[number + 1 :]

    def to(point: Point) -> Draft:
        return draft.changed({item: (*before, desk.snapped(point), *after)})

    return Grip(to, at, "dot" if new else "square", k, at_once=new)


def _sides(desk: Desk, item: Item) -> list[Grip]:
    """Resize a rectangular prop by any corner; the opposite one stays."""
    draft = desk.draft
    if item.kind != "prop" or draft.things[item].side_lengths is None:
        return []
    ((corners, _),) = draft.rims(item)

    def to(fixed: Point, point: Point) -> Draft:
        goal = desk.snapped(point)
        return draft.with_parts([item], lambda prop: spanned(prop, fixed, goal))

    return [Grip(partial(to, corners[k - 2]), corner, "square") for k, corner in enumerate(corners)]


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
