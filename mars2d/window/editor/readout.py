"""What is said of the selection."""

from __future__ import annotations

from itertools import pairwise
from math import degrees, hypot

from mars2d.bodies.props import Ball, Box, Puck
from mars2d.bodies.props.base import Prop
from mars2d.core.errors import counted
from mars2d.core.plane import Outline, Point, edges_of
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Item
from mars2d.window.editor.tool import minus, sides

__all__ = ["described"]


def described(desk: Desk) -> list[str]:
    """Return what is selected, where it is and how large, in lines."""
    draft, items = desk.draft, desk.selection
    if not items:
        return []
    if len(items) > 1:
        return [counted(len(items), "thing")]
    item = items[0]
    corners, pose = draft.corners(item), draft.pose(item)
    lines = [draft.name(item)]
    if pose is not None:
        lines.append(f"{_place(pose[:2])}   θ {degrees(pose[2]) + 0.0:.4g}°")
    elif corners is None:
        lines.append(_place(draft.place(item)))
    elif desk.corner is not None:
        lines.append(f"corner {desk.corner}   {_place(corners[desk.corner])}")
    else:
        lines.append(f"{counted(len(corners), 'corner')}, {_length(item, corners)}")
    if item.kind == "prop":
        lines += _size(draft.props[item.number])
    return [minus(line) for line in lines]


def _place(point: Point) -> str:
    return f"x {point[0]:.4g} m   y {point[1]:.4g} m"


def _length(item: Item, corners: Outline) -> str:
    """Return how long a wall is, or the way round an outline."""
    edges = pairwise(corners) if item.kind == "wall" else edges_of(corners)
    length = sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in edges)
    return f"{length:.4g} m {'long' if item.kind == 'wall' else 'round'}"


def _size(prop: Prop) -> list[str]:
    if isinstance(prop, Box):
        return [sides(prop.length, prop.width)]
    if isinstance(prop, (Ball, Puck)):
        return [f"diameter {prop.diameter:.4g} m"]
    return []
