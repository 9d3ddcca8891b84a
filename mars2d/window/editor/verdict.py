"""The verdict on a draft: whether it is a valid scenario; if not, the fault and its items."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice, pairwise
from typing import TYPE_CHECKING, NamedTuple

import shapely

from mars2d.core.errors import Mars2dError
from mars2d.scenario import starts
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor.item import Item

if TYPE_CHECKING:
    from mars2d.window.editor.draft import Draft

MAX_FAULTS = 50
"""The search stops after this many faults."""


class Fault(NamedTuple):
    """A fault in words, and the items that it concerns."""

    text: str
    culprits: tuple[Item, ...] = ()


class Verdict(NamedTuple):
    """The scenario of a draft, None if the draft is not valid; and its faults."""

    scenario: Scenario | None
    faults: tuple[Fault, ...] = ()

    @property
    def text(self) -> str:
        """The faults in one line, "" if there are none."""
        if not self.faults:
            return ""
        more = len(self.faults) - 1
        also = f" (and {more} more)" if more else ""
        return f"{self.faults[0].text}{also}"

    @property
    def culprits(self) -> frozenset[Item]:
        """All items that something is wrong with."""
        return frozenset(item for fault in self.faults for item in fault.culprits)


def judge(draft: Draft) -> Verdict:
    """Return the verdict on a draft: the Scenario itself decides whether it is valid."""
    if not draft.robots:
        return Verdict(None, (Fault("there is no robot yet: choose Robot (R) and click"),))
    try:
        scenario = draft.scenario()
    except Mars2dError as error:
        found = tuple(islice(_misplaced(draft), MAX_FAULTS))
        return Verdict(None, found or (Fault(str(error)),))
    stray = tuple(_stray(draft))
    return Verdict(None if stray else scenario, stray)


def _misplaced(draft: Draft) -> Iterator[Fault]:
    """Find bodies that start where the Scenario does not allow it."""
    bodies = [Item("robot", i) for i in range(len(draft.robots))]
    bodies += [Item("prop", i) for i in range(len(draft.props))]
    obstacles = list(_obstacles(draft))
    for found in starts.faults(draft.sketch, draft.sketch.bodies):
        item = bodies[found.body]
        name, other = draft.name(item), item
        if found.kind == "overlap":
            other = bodies[found.other]
            text = f"{name} and {draft.name(other)} overlap by {found.depth:.2g} m"
        elif found.kind == "obstacle":
            other = obstacles[found.other] or item
            what = "an obstacle" if other is item else draft.name(other)
            inside = f"starts inside {what}; if it is a room, draw it as walls"
            text = f"{name} {inside if found.inside else f'starts in contact with {what}'}"
        else:
            where = "outside" if found.kind == "outside" else "in the wall round"
            text = f"{name} starts {where} the workspace"
        yield Fault(text, (item, other))


def _obstacles(draft: Draft) -> Iterator[Item | None]:
    """Return the items of the obstacles; None for those that other add-ons make."""
    mine = {outline: Item("outline", i) for i, outline in enumerate(draft.listed["outline"])}
    for i, wall in enumerate(draft.listed["wall"]):
        mine |= dict.fromkeys(pairwise(wall), Item("wall", i))
    for outline in draft.sketch.obstacles:
        yield mine.get(outline)


def _stray(draft: Draft) -> Iterator[Fault]:
    """Find waypoints outside the workspace."""
    ring = None if draft.base.on_exit == "ignore" else draft.base.workspace
    for item, point in draft.things.items() if ring else ():
        if item.kind == "waypoint" and not shapely.Polygon(ring).covers(shapely.Point(point)):
            yield Fault(f"{draft.name(item)} lies outside the workspace", (item,))
