"""The latest other branch of a run, drawn as ghosts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.bodies import bounding_circle, draw_prop, draw_robot
from mars2d.record.frame import Frame
from mars2d.world.timeline import Timeline
from mars2d.world.world import World

Float = NDArray[np.float64]

MAX_BODIES, MAX_PATHS = 6, 3
"""How many bodies and paths of a branch are drawn: those farthest from the present branch."""
APART = 1e-6
"""Bodies this near to their pose in the present branch are not drawn, metres or radians."""
NAME_COLOR = "#707070"


def ghosts(timeline: Timeline, frame: Frame) -> Scene:
    """Return the bodies of the latest other branch at a frame's time, hollow, with their paths.

    Bodies at the same pose as in the present branch are left out.
    """
    scene = Scene()
    for world in timeline.branches[-1:]:
        _Ghost(world, timeline.parted(world), frame).draw(scene)
    return scene


class _Ghost:
    """Another branch at the time of a frame."""

    def __init__(self, world: World, parted: int, frame: Frame) -> None:
        self.world, self.parted, self.frame = world, parted, frame
        # Times are whole numbers of steps, except for rounding.
        along = round(frame.time / frame.scenario.sampling_time, 6)
        self.along = min(along, float(world.iteration))

    def draw(self, scene: Scene) -> None:
        """Draw the bodies that are elsewhere."""
        if self.along < self.parted:
            return
        here = self.frame.all_poses
        there = np.hstack(
            [self._pose(self.world.history.pose, self.world.pose),
             self._pose(self.world.history.prop_pose, self.world.prop_pose)]
        )  # fmt: skip
        apart = np.abs(there - here).max(axis=0)
        drawn = [body for body in np.argsort(-apart)[:MAX_BODIES].tolist() if apart[body] > APART]
        for body in drawn[:MAX_PATHS]:
            self._path(scene, body, there[:2, body])
        for body in drawn:
            self._body(scene, body, there[:, body])
        if drawn:
            self._name(scene, drawn[0], there[:, drawn[0]])

    def _pose(self, history: Float, newest: Float) -> Float:
        """Return the poses (3, n) at the frame's time, interpolated between two steps."""
        row, share = int(self.along), self.along % 1.0
        first = history[row] if row < len(history) else newest
        if not share:
            return first
        second = history[row + 1] if row + 1 < len(history) else newest
        return np.asarray(first + share * (second - first))

    def _path(self, scene: Scene, body: int, there: Float) -> None:
        """Draw the path of a body since the branches parted, dashed."""
        n, history = len(self.world.scenario.robots), self.world.history
        poses, column = (history.pose, body) if body < n else (history.prop_pose, body - n)
        way = poses[self.parted : int(self.along) + 1, :2, column]
        stride = 1  # fewer points, the same ones while the path grows
        while len(way) > 128 * stride:
            stride *= 2
        points = np.vstack([way[::stride], there[None]])
        scene.line(
            points, stroke=faded(self.world.scenario.body_colors[body], 0.7), width=1.2, style="--"
        )

    def _body(self, scene: Scene, body: int, pose: Float) -> None:
        """Draw a body, pale and hollow."""
        scenario, color = self.world.scenario, self.world.scenario.body_colors[body]
        n = len(scenario.robots)
        if body >= n:
            draw_prop(scene, scenario.props[body - n], pose, faded(color, 0.2))
            draw_prop(scene, scenario.props[body - n], pose, color, hollow=True)
        elif scenario.animation.show_real_shape:
            draw_robot(scene, scenario.robots[body], pose, faded(color, 0.2), faded(color, 0.0))
            draw_robot(scene, scenario.robots[body], pose, None, faded(color, 0.7))
        else:
            scene.circle(pose[:2], 0.0, stroke=faded(color, 0.7), pixels=5.0)

    def _name(self, scene: Scene, body: int, pose: Float) -> None:
        """Write when the branch begins, and when it is over."""
        text = f"branch from {self.parted * self.frame.scenario.sampling_time:.4g} s"
        if self.world.over and self.along >= self.world.iteration:
            text += f", over at {self.world.time:.4g} s"
        (x, y), radius = bounding_circle(self.world.scenario.bodies[body].shape, pose)
        place = x, y + 1.15 * radius
        scene.text(place, text, color=NAME_COLOR, size=12, anchor="above", halo="#ffffff")
