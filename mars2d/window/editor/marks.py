"""What is drawn over a draft, and its measures in words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import pairwise
from math import degrees, hypot

from mars2d.core.errors import counted
from mars2d.core.plane import Point, edges_of
from mars2d.core.scene import Scene, faded
from mars2d.output.raster.theme import LIGHT
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.item import Item, angle_of
from mars2d.window.panels.readout import in_both_units

MARK, PAPER = LIGHT.selected, LIGHT.paper
IDLE, IDLE_SIZE = LIGHT.waiting.ink, 12.0
RED = LIGHT.error.ink


def draw_outline(
    draft: Draft, item: Item, scene: Scene, stroke: str, width: float, fill: str | None = None
) -> None:
    """Draw the outlines of an item."""
    for points, radius in draft.rims(item):
        if len(points) == 1:
            pixels = 0.0 if radius else 9.0
            look = {"fill": fill} if radius else {}
            scene.circle(points[0], radius, stroke=stroke, width=width, pixels=pixels, **look)
        elif draft.is_line(item):
            scene.line(points, stroke=stroke, width=width)
        else:
            inside = None if item.kind == "workspace" else fill
            scene.polygon(points, stroke=stroke, fill=inside, width=width)


def draw_marks(
    draft: Draft, selection: Iterable[Item], culprits: Iterable[Item], scene: Scene
) -> None:
    """Draw the outlines of selected items, and faulty ones in red."""
    for item in selection:
        draw_outline(draft, item, scene, PAPER, 4.5)
        draw_outline(draft, item, scene, MARK, 2.2)
    for item in culprits:
        if item in draft.things:
            draw_outline(draft, item, scene, RED, 3.0, faded(RED, 0.3))


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


# -- in words -------------------------------------------------------------------------------------


def described(draft: Draft, items: tuple[Item, ...]) -> list[str]:
    """Return lines about items: name, position, size."""
    if len(items) > 1:
        return [counted(len(items), "thing")]
    (item,) = items
    corners, body, (x, y) = draft.corners(item), draft.body(item), draft.place(item)
    lines = [draft.name(item)]
    if corners:
        edges = pairwise(corners) if item.kind == "wall" else edges_of(corners)
        length = sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in edges)
        way = "long" if item.kind == "wall" else "round"
        lines.append(f"{counted(len(corners), 'corner')}, {length:.4g} m {way}")
    elif draft.starts_at_random(item):
        lines.append("starts at random, until it is moved")
    else:
        lines.append(f"x {x:.4g} m   y {y:.4g} m")
        lines += [] if body is None else [f"θ {in_both_units(body.pose[2])}"]
    return [minus(line) for line in lines]


def measure(draft: Draft, item: Item) -> str:
    """Return the heading of a robot, the size of a prop or an outline; "" for other items."""
    body = draft.body(item)
    xmin, xmax, ymin, ymax = draft.bounds([item])
    if item.kind == "robot" and body is not None:
        return in_both_units(body.pose[2])
    if body is not None and body.is_disc:
        return f"diameter {2 * body.bound[1]:.4g} m"
    if item.kind == "outline":
        return f"{xmax - xmin:.4g} m x {ymax - ymin:.4g} m"
    lengths = None if body is None else draft.things[item].side_lengths
    return "" if lengths is None else "{:.4g} m x {:.4g} m".format(*lengths)


def stretch(a: Point, b: Point) -> str:
    """Return the length and direction of an edge."""
    length = hypot(b[0] - a[0], b[1] - a[1])
    turn = round(degrees(angle_of(a, b)), 1) + 0.0
    return minus(f"{length:.4g} m   {turn:g}°") if length else ""


def minus(text: str) -> str:
    """Return a text with true minus signs in place of hyphens."""
    return text.replace("-", "\N{MINUS SIGN}")
