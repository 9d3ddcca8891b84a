"""Measures in words: of the selection, of edges, of rectangles."""

from __future__ import annotations

from itertools import pairwise
from math import degrees, hypot

from mars2d.core.errors import counted
from mars2d.core.plane import Outline, Point, edges_of
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.item import Item, angle_of
from mars2d.window.panels.readout import in_both_units


def described(desk: Desk) -> list[str]:
    """Return lines about the selection: name, position, size."""
    draft, items = desk.draft, desk.selection
    if not items:
        return []
    if len(items) > 1:
        return [counted(len(items), "thing")]
    item = items[0]
    corners, pose = draft.corners(item), draft.pose(item)
    lines = [draft.name(item)]
    if pose is not None and draft.starts_at_random(item):
        lines.append("starts at random, until it is moved")
    elif pose is not None:
        lines += [_place(pose[:2]), f"θ {in_both_units(pose[2])}"]
    elif corners is None:
        lines.append(_place(draft.place(item)))
    else:
        lines.append(f"{counted(len(corners), 'corner')}, {_length(item, corners)}")
    return [minus(line) for line in lines]


def _place(point: Point) -> str:
    return f"x {point[0]:.4g} m   y {point[1]:.4g} m"


def _length(item: Item, corners: Outline) -> str:
    """Return the length of a wall, or of the way round an outline."""
    edges = pairwise(corners) if item.kind == "wall" else edges_of(corners)
    length = sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in edges)
    return f"{length:.4g} m {'long' if item.kind == 'wall' else 'round'}"


def size_of(draft: Draft, item: Item) -> str:
    """Return the size of a rectangular or round prop, "" for other items."""
    body = draft.body(item)
    if item.kind != "prop" or body is None:
        return ""
    lengths = draft.value(item).side_lengths
    if lengths is not None:
        return sides(*lengths)
    return f"diameter {2 * body.bound[1]:.4g} m" if body.is_disc else ""


def turned(draft: Draft, item: Item) -> str:
    """Return the heading of a robot or prop, "" for other items."""
    pose = draft.pose(item)
    return "" if pose is None else in_both_units(pose[2])


def stretch(a: Point, b: Point) -> str:
    """Return the length and direction of an edge."""
    length = hypot(b[0] - a[0], b[1] - a[1])
    turn = round(degrees(angle_of(a, b)), 1) + 0.0
    return minus(f"{length:.4g} m   {turn:g}°") if length else ""


def sides(length: float, width: float) -> str:
    """Return the length and width of a rectangle."""
    return f"{length:.4g} m x {width:.4g} m"


def minus(text: str) -> str:
    """Return a text with true minus signs in place of hyphens."""
    return text.replace("-", "\N{MINUS SIGN}")
