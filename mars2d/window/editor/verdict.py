"""The verdict on a draft: whether it is a valid scenario; if not, the fault and its items."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mars2d.bodies.rigid import Rigid
from mars2d.core import checks
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.plane import Outline, outside_polygon
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


@dataclass(frozen=True)
class Fault:
    """A fault in words, and the items that it concerns."""

    text: str
    culprits: tuple[Item, ...] = ()


@dataclass(frozen=True)
class Verdict:
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
    for i, outline in enumerate(draft.outlines):
        wrong = flaw(outline, f"obstacle {i}")
        if wrong is not None:
            yield Fault(wrong, (Item("outline", i),))
    for i, wall in enumerate(draft.walls):
        try:
            checks.polylines("walls", [wall])
        except InputError as error:
            yield Fault(str(error).replace("walls[0]", f"wall {i}"), (Item("wall", i),))
    if draft.workspace is not None:
        try:
            checks.outline("the workspace", draft.workspace, least=3)
        except InputError as error:
            yield Fault(str(error), (Item("workspace"),))


def _misplaced(draft: Draft) -> Iterator[Fault]:
    """Find bodies that start where the Scenario does not allow it."""
    items = [item for item in draft.items() if item.kind in ("robot", "prop")]
    items.sort(key=lambda item: item.kind == "prop")  # as in Scenario.bodies
    bodies = [body for item in items if (body := draft.body(item)) is not None]
    yield from _outside(draft, items, bodies)
    yield from _in_obstacles(draft, items, bodies)
    yield from _overlapping(draft, items, bodies)


def _outside(draft: Draft, items: list[Item], bodies: list[Rigid]) -> Iterator[Fault]:
    """Find robots outside the workspace, and bodies in its wall."""
    base, workspace = draft.base, draft.workspace
    if workspace is None or base.on_exit == "ignore":
        return
    for item, body in zip(items, bodies, strict=True):
        try:
            if item.kind == "robot":
                starts.check_in_workspace([body], workspace)
        except InputError:
            yield Fault(f"{body.name} starts outside the workspace", (item,))
            continue
        try:
            if base.on_exit == "wall":
                starts.check_off_walls([body], workspace, base.max_overlap)
        except InputError:
            yield Fault(f"{body.name} starts in the wall round the workspace", (item,))


def _in_obstacles(draft: Draft, items: list[Item], bodies: list[Rigid]) -> Iterator[Fault]:
    """Find bodies in obstacles."""
    obstacles = list(_obstacles(draft))
    if not obstacles:
        return
    corners = [np.array(outline) for outline, _ in obstacles]
    low = np.array([ring.min(axis=0) for ring in corners])
    high = np.array([ring.max(axis=0) for ring in corners])
    for item, body in zip(items, bodies, strict=True):
        center, radius = body.bound
        near = (low <= np.add(center, radius)).all(axis=1)
        near &= (high >= np.subtract(center, radius)).all(axis=1)
        for k in np.flatnonzero(near).tolist():
            outline, obstacle = obstacles[k]
            try:
                starts.check_off_obstacles([body], [outline], draft.base.max_overlap)
            except InputError:
                what = "an obstacle" if obstacle is None else draft.name(obstacle)
                within = inside(center, outline)
                hint = "; if it is a room, draw it as walls" if within else ""
                where = "inside" if within else "in contact with"
                culprits = (item,) if obstacle is None else (item, obstacle)
                yield Fault(f"{body.name} starts {where} {what}{hint}", culprits)
                break


def _obstacles(draft: Draft) -> Iterator[tuple[Outline, Item | None]]:
    """Return the obstacles with their items; None for those that other add-ons make."""
    mine: set[Outline] = set()
    for i, outline in enumerate(draft.outlines):
        mine.add(outline)
        yield outline, Item("outline", i)
    for i, wall in enumerate(draft.walls):
        for piece in pairwise(wall):
            mine.add(piece)
            yield piece, Item("wall", i)
    for outline in draft.sketch.obstacles:
        if outline not in mine:
            yield outline, None


def _overlapping(draft: Draft, items: list[Item], bodies: list[Rigid]) -> Iterator[Fault]:
    """Find bodies that overlap, unless a hinge joins them."""
    joined = draft.sketch.joined
    centers = np.array([body.bound[0] for body in bodies])
    radii = np.array([body.bound[1] for body in bodies])
    for i, a in enumerate(bodies[:-1]):
        gaps = np.hypot(*(centers[i + 1 :] - centers[i]).T) - radii[i + 1 :] - radii[i]
        for k in (np.flatnonzero(gaps < 0) + i + 1).tolist():
            if (i, k) in joined:
                continue
            try:
                starts.check_apart([a, bodies[k]], draft.base.max_overlap)
            except InputError:
                deep = _depth(a, bodies[k], -float(gaps[k - i - 1]))
                text = f"{a.name} and {bodies[k].name} overlap by {deep:.2g} m"
                yield Fault(text, (items[i], items[k]))


def _depth(a: Rigid, b: Rigid, of_bounds: float) -> float:
    """Return about how deep two bodies overlap, metres; of_bounds: the same for their bounds."""
    if a.is_disc and b.is_disc:
        return of_bounds
    import shapely

    common = shapely.intersection(starts.footprint(a), starts.footprint(b))
    return float(2 * shapely.maximum_inscribed_circle(common).length)


def _stray(draft: Draft) -> Iterator[Fault]:
    """Find waypoints outside the workspace."""
    if draft.workspace is None or draft.base.on_exit == "ignore":
        return
    ring = np.array(draft.workspace)
    for item in draft.items():
        if item.kind == "waypoint":
            x, y = np.array([draft.place(item)]).T
            if outside_polygon(x, y, ring)[0]:
                yield Fault(f"{draft.name(item)} lies outside the workspace", (item,))
