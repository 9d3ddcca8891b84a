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

Fault = tuple[str, tuple[Item, ...]]
"""A fault in words, and the items that it concerns."""


class Verdict(NamedTuple):
    """The scenario of a draft, None if it is not valid; what is wrong, and all items concerned."""

    scenario: Scenario | None
    text: str = ""
    culprits: frozenset[Item] = frozenset()


def judge(draft: Draft) -> Verdict:
    """Return the verdict on a draft: the Scenario itself decides whether it is valid."""
    if not draft.base.robots:
        return Verdict(None, "there is no robot yet: choose Robot (R) and click")
    scenario, text = None, ""
    try:
        scenario = draft.scenario()
    except Mars2dError as error:
        text = str(error)
    found = _misplaced(draft) if scenario is None else _stray(draft)
    faults = list(islice(found, MAX_FAULTS))
    if faults:
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        scenario, text = None, f"{faults[0][0]}{more}"
    return Verdict(scenario, text, frozenset(item for _, items in faults for item in items))


def _misplaced(draft: Draft) -> Iterator[Fault]:
    """Find bodies that start where the Scenario does not allow it."""
    bodies = [item for kind in ("robot", "prop") for item in draft.items() if item.kind == kind]
    mine = {outline: Item("outline", i) for i, outline in enumerate(draft.listed["outline"])}
    for i, wall in enumerate(draft.listed["wall"]):
        mine |= dict.fromkeys(pairwise(wall), Item("wall", i))
    for found in starts.faults(draft.sketch, draft.sketch.bodies):
        item = bodies[found.body]
        name, other = draft.name(item), item
        if found.kind == "overlap":
            other = bodies[found.other]
            text = f"{name} and {draft.name(other)} overlap by {found.depth:.2g} m"
        elif found.kind == "obstacle":
            other = mine.get(draft.sketch.obstacles[found.other], item)  # or another add-on's
            what = "an obstacle" if other is item else draft.name(other)
            inside = f"starts inside {what}; if it is a room, draw it as walls"
            text = f"{name} {inside if found.inside else f'starts in contact with {what}'}"
        else:
            where = "outside" if found.kind == "outside" else "in the wall round"
            text = f"{name} starts {where} the workspace"
        yield text, (item, other)


def _stray(draft: Draft) -> Iterator[Fault]:
    """Find waypoints outside the workspace."""
    if draft.base.on_exit == "ignore" or draft.base.workspace is None:
        return
    ring = shapely.Polygon(draft.base.workspace)
    for item in draft.items():
        if item.kind == "waypoint" and not ring.covers(draft.shape(item)):
            yield f"{draft.name(item)} lies outside the workspace", (item,)
