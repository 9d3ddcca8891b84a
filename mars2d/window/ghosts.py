"""The other branches of a run, seen beside the present one, and what is marked on its time bar."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Anchor, Line, Scene, faded
from mars2d.output.layers.bodies import draw_prop, draw_robot, prop_colors
from mars2d.output.layers.forces import bounding_circle
from mars2d.record.frame import Frame
from mars2d.window.timebar import MarkKind
from mars2d.world.timeline import Timeline
from mars2d.world.world import World

__all__ = ["Marks", "ghosts"]

Float = NDArray[np.float64]

SIDES: tuple[Anchor, ...] = ("above", "below", "left")
"""On which side of a body the name of a branch stands: each on another one."""
MOST = len(SIDES)
"""So many branches are seen at once, those that were left last."""
BODIES, PATHS = 6, 3
"""So many bodies of each, and paths, of those that are the farthest from where they are now."""
POINTS = 64
"""Of a path, at most twice as many."""
DASH = 0.008
"""How long the dashes of paths are, in widths of the workspace; longer ones if they are many."""
DASHES = 80
"""So many dashes of each branch."""
APART = 1e-6
"""Bodies nearer to where they are in the present branch are not drawn, metres or radians."""
NAMED = "#707070"
EVERY = 0.25
"""Collisions are looked for no more often, seconds."""


def ghosts(timeline: Timeline, frame: Frame) -> Scene:
    """Return where the other branches are at a frame's time: hollow, with the paths that led there.

    Bodies that are at the same place in the present branch are left out.
    """
    scene = Scene()
    for world, side in zip(timeline.branches[-MOST:], SIDES, strict=False):
        _Ghost(world, timeline.parted(world), frame).draw(scene, side)
    return scene


class _Ghost:
    """Another branch at the time of a frame."""

    def __init__(self, world: World, parted: int, frame: Frame) -> None:
        self.world, self.parted, self.frame = world, parted, frame
        self.along = min(frame.time / frame.scenario.sampling_time, float(world.iteration))
        # Times are whole numbers of steps, but for rounding.
        if abs(self.along - round(self.along)) < 1e-6:
            self.along = float(round(self.along))

    def draw(self, scene: Scene, side: Anchor) -> None:
        """Draw those bodies that are elsewhere now; side: where the name of the branch stands."""
        if self.along < self.parted:
            return
        here = np.hstack([self.frame.pose, self.frame.prop_pose])
        there = np.hstack(
            [self._pose(self.world.history.pose, self.world.pose),
             self._pose(self.world.history.prop_pose, self.world.prop_pose)]
        )  # fmt: skip
        apart = np.abs(there - here).max(axis=0)
        drawn = [body for body in np.argsort(-apart)[:BODIES].tolist() if apart[body] > APART]
        if drawn:
            self._paths(scene, drawn[:PATHS], there)
            for body in drawn:
                self._body(scene, body, there[:, body])
            self._name(scene, drawn[0], there[:, drawn[0]], side)

    def _pose(self, history: Float, newest: Float) -> Float:
        """Return poses (3, n) at this time; between two steps on the straight line."""
        row, share = int(self.along), self.along % 1.0
        first = history[row] if row < len(history) else newest
        if not share:
            return first
        second = history[row + 1] if row + 1 < len(history) else newest
        return np.asarray(first + share * (second - first))

    def _paths(self, scene: Scene, bodies: Sequence[int], there: Float) -> None:
        """Draw the ways of some bodies since the branches parted, dashed."""
        n = len(self.world.scenario.robots)
        history = self.world.history
        rows = slice(self.parted, int(self.along) + 1)
        ways = [
            np.vstack([_thinned(poses[rows, :2, column]), there[None, :2, body]])
            for body in bodies
            for poses, column in [
                (history.pose, body) if body < n else (history.prop_pose, body - n)
            ]
        ]
        xmin, xmax, ymin, ymax = self.frame.scenario.bounds
        dash = DASH * max(xmax - xmin, ymax - ymin)
        while sum(map(_length, ways)) > 2 * DASHES * dash:
            dash *= 2
        for body, way in zip(bodies, ways, strict=True):
            color = faded(self._color(body), 0.7)
            scene.extend(Line(piece, color, 1.2) for piece in _dashed(way, dash))

    def _color(self, body: int) -> str:
        scenario = self.world.scenario
        n = len(scenario.robots)
        return scenario.colors[body] if body < n else prop_colors(scenario.props)[body - n]

    def _body(self, scene: Scene, body: int, pose: Float) -> None:
        """Draw a body pale and hollow."""
        scenario, color = self.world.scenario, self._color(body)
        n = len(scenario.robots)
        if body >= n:
            draw_prop(scene, scenario.props[body - n], pose, faded(color, 0.2))
            draw_prop(scene, scenario.props[body - n], pose, color, hollow=True)
        elif scenario.animation.show_real_shape:
            draw_robot(scene, scenario.robots[body], pose, faded(color, 0.2), faded(color, 0.0))
            draw_robot(scene, scenario.robots[body], pose, None, faded(color, 0.7))
        else:
            scene.circle(pose[:2], 0.0, stroke=faded(color, 0.7), pixels=5.0)

    def _name(self, scene: Scene, body: int, pose: Float, side: Anchor) -> None:
        """Say from when on this branch is another one, and when it has come to its end."""
        dt = self.frame.scenario.sampling_time
        text = f"branch from {self.parted * dt:.4g} s"
        if self.world.over and self.along >= self.world.iteration:
            text += f", over at {self.world.time:.4g} s"
        (x, y), radius = bounding_circle(self.world.scenario.bodies[body].shape, pose)
        dx, dy = {"above": (0, 1), "below": (0, -1), "left": (1, 0)}[side]
        place = x + 1.15 * radius * dx, y + 1.15 * radius * dy
        scene.text(place, text, color=NAMED, size=12, anchor=side, halo="#ffffff")


def _thinned(path: Float) -> Float:
    """Return a path (k, 2) with fewer points, always the same ones while it grows."""
    stride = 1
    while len(path) > 2 * POINTS * stride:
        stride *= 2
    return path[::stride]


def _length(path: Float) -> float:
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def _dashed(path: Float, dash: float) -> Float:
    """Return the dashes (m, 2, 2) of a path (k, 2): their ends, on straight lines."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))])
    starts = np.arange(0.0, along[-1], 2 * dash)
    ends = np.minimum(starts + dash, along[-1])
    at = np.stack([starts, ends], axis=1)
    return np.stack([np.interp(at, along, path[:, axis]) for axis in (0, 1)], axis=2)


class Marks:
    """What happened in a run, by rows: when bodies came to touch, when hands did something, ..."""

    def __init__(self, timeline: Timeline) -> None:
        """Start with nothing seen."""
        self._timeline = timeline
        self._world: World | None = None
        self._seen = 0  # contacts
        self._next = 0.0
        self._touched: list[int] = []
        self._handled: tuple[World | None, int, list[int]] = None, 0, []

    def rows(self) -> Mapping[MarkKind, Sequence[int]]:
        """Return the rows of each kind, in ascending order; of collisions those of a moment ago."""
        timeline, world = self._timeline, self._timeline.world
        self._look(world, time.monotonic())
        return {
            "collision": self._touched,
            "hand": self._by_hand(world),
            "branch": sorted({timeline.parted(other) for other in timeline.branches}),
            "error": [world.iteration] if world.over and not world.finished else [],
        }

    def _by_hand(self, world: World) -> list[int]:
        """Return the rows at which hands did something."""
        log = world.hands.log
        if self._handled[:2] != (world, len(log)):
            self._handled = world, len(log), sorted({each.row for each in log})
        return self._handled[2]

    def _look(self, world: World, now: float) -> None:
        """Look for contacts that began since the last look."""
        if world is not self._world:
            self._world, self._seen, self._next, self._touched = world, 0, 0.0, []
        if now < self._next:
            return
        self._next = now + EVERY
        contacts = world.frame.contact_log()
        new = contacts[self._seen :]
        self._seen = len(contacts)
        steps = new["time"][new["began"]] / world.sampling_time
        rows = np.ceil(steps - 1e-6).astype(int).tolist()
        self._touched += sorted(set(rows) - set(self._touched[-1:]))
