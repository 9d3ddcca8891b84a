"""What is drawn over a draft, and its measures in words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import degrees, dist

from mars2d.core.errors import counted
from mars2d.core.plane import Point
from mars2d.core.scene import Scene, faded
from mars2d.output.raster.theme import LIGHT
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.item import Item, angle_of
from mars2d.window.panels.readout import in_both_units
from mars2d.window.widgets.rows import minus

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
    for i, robot in enumerate(draft.base.robots):
        words = ["at random"] if draft.starts_at_random(Item("robot", i)) else []
        if i in idle:
            words.append("no law" if idle[i] == "a law" else f"lacks {idle[i]}")
        (x, y), radius = robot.rigid.bound
        text, below = ", ".join(words), (x, y - radius)
        if text:
            scene.text(below, text, color=IDLE, size=IDLE_SIZE, anchor="below", halo=PAPER)


# -- in words -------------------------------------------------------------------------------------


def described(draft: Draft, item: Item) -> list[str]:
    """Return lines about an item: name, position, heading, size."""
    (x, y), corners, body = draft.place(item), draft.corners(item), draft.body(item)
    lines, shape = [draft.name(item)], draft.shape(item)
    lines.append(counted(len(corners), "corner") if corners else f"x {x:.4g} m   y {y:.4g} m")
    xmin, ymin, xmax, ymax = shape.bounds
    sides = (xmax - xmin, ymax - ymin) if corners else None
    if body is not None:
        sides = getattr(draft.things[item], "side_lengths", None)
        lines.append(f"θ {in_both_units(body.pose[2])}")
        if draft.starts_at_random(item):
            lines[1:] = ["starts at random, until it is moved"]
        elif item.kind == "prop" and body.is_disc:
            lines.append(f"diameter {2 * body.bound[1]:.4g} m")
    if draft.is_line(item):
        lines.append(f"{shape.length:.4g} m long")
    elif sides is not None:
        lines.append(f"{sides[0]:.4g} m x {sides[1]:.4g} m")
    return [minus(line) for line in lines]


def stretch(a: Point, b: Point) -> str:
    """Return the length and direction of an edge."""
    length, turn = dist(a, b), round(degrees(angle_of(a, b)), 1) + 0.0
    return minus(f"{length:.4g} m   {turn:g}°") if length else ""
