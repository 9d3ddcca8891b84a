"""Which item, edge or corner lies under the pointer."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
import shapely

from mars2d.core.plane import Point
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.item import Item, Kind
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
    kinds: tuple[Kind, ...] = ("wall", "outline")
    for kind in kinds:
        shapes = [
            shapely.LineString(corners)
            if kind == "wall" or len(corners) == 2
            else shapely.Polygon(corners)
            for corners in draft.listed(kind)
        ]
        gaps = shapely.distance(shapes, shapely.Point(point))
        hit = np.flatnonzero(gaps <= desk.metres(NEAR)).tolist()
        if hit:
            return Item(kind, hit[-1])
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
