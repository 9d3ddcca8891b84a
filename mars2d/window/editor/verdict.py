"""The verdict on a draft: whether it is a valid scenario; if not, the fault and its items."""

from __future__ import annotations

import time
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mars2d.bodies.rigid import Rigid
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.plane import Outline, Point, outside_polygon
from mars2d.scenario import starts
from mars2d.scenario.scenario import Scenario
from mars2d.window.editor.draft import Draft, flaw
from mars2d.window.editor.item import Item
from mars2d.window.editor.picking import inside

MAX_FAULTS = 50
"""The search stops after this many faults."""
MIN_INTERVAL = 0.1
"""The shortest time between two judgements during a drag, seconds."""
MIN_INTERVAL_COSTS = 8.0
"""The same as a multiple of the time that the last judgement took."""


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
    faults = list(_flaws(draft))
    if faults:
        return Verdict(None, tuple(faults))
    if not draft.robots:
        return Verdict(None, (Fault("there is no robot yet: choose Robot (R) and click"),))
    try:
        scenario = draft.scenario()
    except Mars2dError as error:
        found = tuple(fault for fault, _ in zip(_misplaced(draft), range(MAX_FAULTS), strict=False))
        return Verdict(None, found or (Fault(str(error)),))
    stray = tuple(_stray(draft))
    return Verdict(None if stray else scenario, stray)


class Judge:
    """Judges drafts as they change, each only once; verdict: the last verdict."""

    def __init__(self, draft: Draft) -> None:
        """Judge the first draft."""
        self.verdict = judge(draft)
        self._draft, self._when, self._cost = draft, 0.0, 0.0

    def of(self, draft: Draft, *, at_once: bool = True) -> Verdict:
        """Return the verdict on a draft; without `at_once` it may be that on an earlier draft."""
        now = time.perf_counter()
        wait = 0.0 if at_once else max(MIN_INTERVAL, MIN_INTERVAL_COSTS * self._cost)
        if draft is not self._draft and now - self._when >= wait:
            self.verdict, self._draft = judge(draft), draft
            self._when = time.perf_counter()
            self._cost = self._when - now
        return self.verdict


def _flaws(draft: Draft) -> Iterator[Fault]:
    """Find invalid outlines."""
    for item in (*draft.items(), Item("workspace")):
        corners, least = draft.corners(item), 3 if item.kind == "workspace" else 2
        if corners is not None:
            wrong = flaw(corners, draft.name(item), least, closed=item.kind != "wall")
            if wrong:
                yield Fault(wrong, (item,))


def _misplaced(draft: Draft) -> Iterator[Fault]:
    """Find bodies that start where the Scenario does not allow it."""
    items = [item for item in draft.items() if item.kind in ("robot", "prop")]
    items.sort(key=lambda item: item.kind == "prop")  # as in Scenario.bodies
    bodies = [draft.value(item).rigid for item in items]
    overlap, obstacles = draft.base.max_overlap, list(_obstacles(draft))
    outlines = tuple(outline for outline, _ in obstacles)
    for item, body in zip(items, bodies, strict=True):
        where = _outside(draft, item, body)
        if where:
            yield Fault(f"{body.name} starts {where}", (item,))
        for k in starts.cut_by(body, outlines, overlap)[:1]:
            outline, obstacle = obstacles[k]
            within = inside(body.bound[0], outline)
            what = "an obstacle" if obstacle is None else draft.name(obstacle)
            where = f"inside {what}; if it is a room, draw it as walls"
            text = where if within else f"in contact with {what}"
            yield Fault(f"{body.name} starts {text}", (item, obstacle or item))
    centers = np.array([body.bound[0] for body in bodies])
    radii = np.array([body.bound[1] for body in bodies])
    for i, a in enumerate(bodies[:-1]):
        gaps = np.hypot(*(centers[i + 1 :] - centers[i]).T) - radii[i + 1 :] - radii[i]
        for k in (np.flatnonzero(gaps < 0) + i + 1).tolist():
            deep = starts.depth(a, bodies[k], overlap)
            if deep and (i, k) not in draft.sketch.joined:
                text = f"{a.name} and {bodies[k].name} overlap by {deep:.2g} m"
                yield Fault(text, (items[i], items[k]))


def _outside(draft: Draft, item: Item, body: Rigid) -> str:
    """Return where a body starts outside the workspace or in its wall, "" for neither."""
    base, workspace = draft.base, draft.workspace
    if workspace is None or base.on_exit == "ignore":
        return ""
    if item.kind == "robot" and not _within(body.pose[:2], workspace):
        return "outside the workspace"
    try:
        if base.on_exit == "wall":
            starts.check_off_walls([body], workspace, base.max_overlap)
    except InputError:
        return "in the wall round the workspace"
    return ""


def _within(point: Point, workspace: Outline) -> bool:
    x, y = np.array([point]).T
    return not outside_polygon(x, y, np.array(workspace))[0]


def _obstacles(draft: Draft) -> Iterator[tuple[Outline, Item | None]]:
    """Return the obstacles with their items; None for those that other add-ons make."""
    mine = {outline: Item("outline", i) for i, outline in enumerate(draft.outlines)}
    for i, wall in enumerate(draft.walls):
        mine |= dict.fromkeys(pairwise(wall), Item("wall", i))
    for outline in draft.sketch.obstacles:
        yield outline, mine.get(outline)


def _stray(draft: Draft) -> Iterator[Fault]:
    """Find waypoints outside the workspace."""
    ring = None if draft.base.on_exit == "ignore" else draft.workspace
    for item in draft.items() if ring else ():
        if item.kind == "waypoint" and not _within(draft.place(item), ring or ()):
            yield Fault(f"{draft.name(item)} lies outside the workspace", (item,))
