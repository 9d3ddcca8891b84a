"""The drawing of a draft: its frame, its selected items, and its faulty ones."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping

from mars2d.core.scene import Scene, faded
from mars2d.output.raster.theme import LIGHT
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor.draft import Draft
from mars2d.window.editor.handles import MARK, PAPER
from mars2d.window.editor.item import Item

IDLE, IDLE_SIZE = LIGHT.waiting.ink, 12.0
RED = LIGHT.error.ink


class Sketch:
    """Makes frames of drafts that follow each other.

    The frame's scenario is the same object as long as only robots, props, waypoints and beacons
    change, so that the unchanged ground need not be drawn again while they are dragged.
    """

    def __init__(self) -> None:
        """Start without a draft."""
        self._draft: Draft | None = None
        self._bare = False
        self._scenario: Scenario | None = None

    def frame(self, draft: Draft, *, bare: bool) -> Frame:
        """Return the instant before the start; bare: with only the add-ons that can be edited."""
        if self._scenario is None or draft is not self._draft or bare is not self._bare:
            fresh = copy.copy(draft.bare_sketch if bare else draft.sketch)
            if self._scenario is None or not self._same_ground(draft, bare=bare):
                self._scenario = fresh
            else:  # a copy that nobody else holds
                self._scenario.__dict__.clear()
                self._scenario.__dict__.update(fresh.__dict__)
            self._draft, self._bare = draft, bare
        return draft.frame(self._scenario)

    def _same_ground(self, draft: Draft, *, bare: bool) -> bool:
        """Return whether a draft has the same obstacles and workspace as the last one."""
        last = self._draft
        return (
            last is not None
            and bare is self._bare
            and last.base is draft.base
            and last.outlines is draft.outlines
            and last.walls is draft.walls
            and last.workspace is draft.workspace
        )


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
