"""What is drawn over a draft: its selected items, its faulty ones, remarks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from mars2d.core.scene import Scene, faded
from mars2d.output.raster.theme import LIGHT
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.handles import MARK, PAPER
from mars2d.window.editor.item import Item

IDLE, IDLE_SIZE = LIGHT.waiting.ink, 12.0
RED = LIGHT.error.ink


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
