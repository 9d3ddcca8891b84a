"""Which item, edge or corner lies under the pointer."""

from __future__ import annotations

from collections.abc import Collection
from itertools import pairwise
from math import hypot

import numpy as np

from mars2d.core.plane import Outline, Point, edges_of, inside_polygon
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.item import Item
from mars2d.window.screen.picking import body_at

NEAR = 6.0
"""A point this far from a line or body still hits it, points of the screen."""

POINT_RADIUS = 9.0
"""The radius of beacons and waypoints on the screen, points."""


def item_at(desk: Desk, point: Point, but: Collection[Item] = ()) -> Item | None:
    """Return the uppermost item at a point [m], or None; the workspace is never returned.

    but: bodies that are looked through.
    """
    draft = desk.draft
    small = [item for item in draft.items() if item.kind in ("waypoint", "beacon")]
    for item in reversed(small):
        if desk.near(point, draft.place(item), POINT_RADIUS):
            return item
    robots = len(draft.robots)
    without = [item.number + robots * (item.kind == "prop") for item in but]
    body = body_at(draft.frame(), point, desk.metres(NEAR / 2), without)
    if body is not None:
        return Item("robot", body) if body < robots else Item("prop", body - robots)
    slack = desk.metres(NEAR)
    for i, wall in reversed(list(enumerate(draft.listed("wall")))):
        if _on_line(point, wall, slack):
            return Item("wall", i)
    for i, outline in reversed(list(enumerate(draft.listed("outline")))):
        if edge_at(point, outline, slack) is not None or inside(point, outline):
            return Item("outline", i)
    return None


def items_within(desk: Desk, a: Point, b: Point) -> list[Item]:
    """Return the items that lie wholly in the rectangle between two corners."""
    (left, right), (low, high) = sorted((a[0], b[0])), sorted((a[1], b[1]))
    found = []
    for item in desk.draft.items():
        xmin, xmax, ymin, ymax = desk.draft.bounds([item])
        if left <= xmin and xmax <= right and low <= ymin and ymax <= high:
            found.append(item)
    return found


def edge_at(point: Point, outline: Outline, slack: float) -> int | None:
    """Return the index of a closed outline's nearest edge, None if it is farther than slack [m]."""
    gaps = [
        hypot(point[0] - x, point[1] - y)
        for x, y in (foot_on(point, *edge) for edge in edges_of(outline))
    ]
    nearest = int(np.argmin(gaps))
    return nearest if gaps[nearest] <= slack else None


def foot_on(point: Point, a: Point, b: Point) -> Point:
    """Return the point on the edge from a to b that is nearest to a point."""
    ex, ey = b[0] - a[0], b[1] - a[1]
    along = ((point[0] - a[0]) * ex + (point[1] - a[1]) * ey) / max(ex * ex + ey * ey, 1e-18)
    along = min(max(along, 0.0), 1.0)
    return a[0] + along * ex, a[1] + along * ey


def _on_line(point: Point, wall: Outline, slack: float) -> bool:
    feet = (foot_on(point, a, b) for a, b in pairwise(wall))
    return any(hypot(point[0] - x, point[1] - y) <= slack for x, y in feet)


def inside(point: Point, outline: Outline) -> bool:
    """Return whether a point lies in a closed outline."""
    x, y = np.array([point], dtype=float).T
    return len(outline) > 2 and bool(inside_polygon(x, y, np.array(outline))[0])
