"""The other branches of a run, drawn as ghosts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.colors import prop_colors
from mars2d.core.scene import Anchor, Scene, faded
from mars2d.output.layers.bodies import bounding_circle, draw_prop, draw_robot
from mars2d.record.frame import Frame
from mars2d.world.timeline import Timeline
from mars2d.world.world import World

Float = NDArray[np.float64]

SIDES: tuple[Anchor, ...] = ("above", "below", "left")
"""The side of a body on which its branch is named: a different one for each branch."""
MAX_BRANCHES = len(SIDES)
"""How many branches are drawn: the latest ones."""
MAX_BODIES, MAX_PATHS = 6, 3
"""How many bodies and paths of a branch are drawn: those farthest from the present branch."""
MIN_POINTS = 64
"""A path is thinned to this many points, or up to twice as many."""
APART = 1e-6
"""Bodies this near to their pose in the present branch are not drawn, metres or radians."""
NAME_COLOR = "#707070"


def ghosts(timeline: Timeline, frame: Frame) -> Scene:
    """Return the bodies of other branches at a frame's time, hollow, with their paths.

    Bodies at the same pose as in the present branch are left out.
    """
    scene = Scene()
    for world, side in zip(timeline.branches[-MAX_BRANCHES:], SIDES, strict=False):
        _Ghost(world, timeline.parted(world), frame).draw(scene, side)
    return scene


class _Ghost:
    """Another branch at the time of a frame."""

    def __init__(self, world: World, parted: int, frame: Frame) -> None:
        self.world, self.parted, self.frame = world, parted, frame
        self.along = min(frame.time / frame.scenario.sampling_time, float(world.iteration))
        # Times are whole numbers of steps, except for rounding.
        if abs(self.along - round(self.along)) < 1e-6:
            self.along = float(round(self.along))

    def draw(self, scene: Scene, side: Anchor) -> None:
        """Draw the bodies that are elsewhere; side: where the branch is named."""
        if self.along < self.parted:
            return
        here = self.frame.all_poses
        there = np.hstack(
            [self._pose(self.world.history.pose, self.world.pose),
             self._pose(self.world.history.prop_pose, self.world.prop_pose)]
        )  # fmt: skip
        apart = np.abs(there - here).max(axis=0)
        drawn = [body for body in np.argsort(-apart)[:MAX_BODIES].tolist() if apart[body] > APART]
        if drawn:
            self._paths(scene, drawn[:MAX_PATHS], there)
            for body in drawn:
                self._body(scene, body, there[:, body])
            self._name(scene, drawn[0], there[:, drawn[0]], side)

    def _pose(self, history: Float, newest: Float) -> Float:
        """Return the poses (3, n) at the frame's time, interpolated between two steps."""
        row, share = int(self.along), self.along % 1.0
        first = history[row] if row < len(history) else newest
        if not share:
            return first
        second = history[row + 1] if row + 1 < len(history) else newest
        return np.asarray(first + share * (second - first))

    def _paths(self, scene: Scene, bodies: Sequence[int], there: Float) -> None:
        """Draw the paths of some bodies since the branches parted, dashed."""
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
        for body, way in zip(bodies, ways, strict=True):
            scene.line(way, stroke=faded(self._color(body), 0.7), width=1.2, style="--")

    def _color(self, body: int) -> str:
        scenario = self.world.scenario
        n = len(scenario.robots)
        return scenario.colors[body] if body < n else prop_colors(scenario.props)[body - n]

    def _body(self, scene: Scene, body: int, pose: Float) -> None:
        """Draw a body, pale and hollow."""
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
        """Write when the branch begins, and when it is over."""
        dt = self.frame.scenario.sampling_time
        text = f"branch from {self.parted * dt:.4g} s"
        if self.world.over and self.along >= self.world.iteration:
            text += f", over at {self.world.time:.4g} s"
        (x, y), radius = bounding_circle(self.world.scenario.bodies[body].shape, pose)
        dx, dy = {"above": (0, 1), "below": (0, -1), "left": (1, 0)}[side]
        place = x + 1.15 * radius * dx, y + 1.15 * radius * dy
        scene.text(place, text, color=NAME_COLOR, size=12, anchor=side, halo="#ffffff")


def _thinned(path: Float) -> Float:
    """Return a path (k, 2) with fewer points: the same ones while the path grows."""
    stride = 1
    while len(path) > 2 * MIN_POINTS * stride:
        stride *= 2
    return path[::stride]
