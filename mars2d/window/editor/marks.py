"""What is drawn over the things of a draft: which are selected, and which are wrong."""

from __future__ import annotations

from collections.abc import Iterable

from mars2d.core.scene import Scene, faded
from mars2d.output.raster.theme import LIGHT
from mars2d.window.editor.draft import Draft, Item
from mars2d.window.editor.handles import MARK, PAPER

__all__ = ["draw_culprits", "draw_selected"]

RED = LIGHT.error.ink


def draw_selected(draft: Draft, items: Iterable[Item], scene: Scene) -> None:
    """Draw the outlines of selected things."""
    for item in items:
        _outline(draft, item, scene, PAPER, 4.5)
        _outline(draft, item, scene, MARK, 2.2)


def draw_culprits(draft: Draft, items: Iterable[Item], scene: Scene) -> None:
    """Draw in red what is wrong."""
    for item in items:
        if draft.holds(item):
            _outline(draft, item, scene, RED, 3.0, faded(RED, 0.3))


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
