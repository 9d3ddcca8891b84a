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
    for branch in timeline.branches[-1:]:
        world, parted = branch.world, timeline.branch.common(branch)
        dt = frame.scenario.sampling_time
        # Times are whole numbers of steps, except for rounding.
        along = min(round(frame.time / dt, 6), float(world.iteration))
        if along < parted:
            continue
        row, share = int(along), along % 1.0
        there = (1 - share) * branch.poses(row) + share * branch.poses(row + 1)
        apart = np.abs(there - frame.all_poses).max(axis=0)
        drawn = [body for body in np.argsort(-apart)[:MAX_BODIES].tolist() if apart[body] > APART]
        for body in drawn[:MAX_PATHS]:
            _draw_path(scene, world, body, (parted, row), there[:2, body])
        for body in drawn:
            _draw_body(scene, world, body, there[:, body])
        for body in drawn[:1]:
            over = (
                f", over at {world.time:.4g} s" if world.over and along >= world.iteration else ""
            )
            shape, pose = world.scenario.bodies[body].shape, there[:, body]
            (x, y), radius = bounding_circle(shape, pose)
            text, place = f"branch from {parted * dt:.4g} s{over}", (x, y + 1.15 * radius)
            scene.text(place, text, color=NAME_COLOR, size=12, anchor="above", halo="#ffffff")
    return scene


def _draw_path(scene: Scene, world: World, body: int, rows: tuple[int, int], there: Float) -> None:
    """Draw the path of a body between two rows and on to a point, dashed."""
    n, history = len(world.scenario.robots), world.history
    poses, column = (history.pose, body) if body < n else (history.prop_pose, body - n)
    way = poses[rows[0] : rows[1] + 1, :2, column]
    stride = 1  # fewer points, the same ones while the path grows
    while len(way) > 128 * stride:
        stride *= 2
    points = np.vstack([way[::stride], there[None]])
    scene.line(points, stroke=faded(world.scenario.body_colors[body], 0.7), width=1.2, style="--")


def _draw_body(scene: Scene, world: World, body: int, pose: Float) -> None:
    """Draw a body, pale and hollow."""
    scenario, color, n = (
        world.scenario,
        world.scenario.body_colors[body],
        len(world.scenario.robots),
    )
    if body >= n:
        draw_prop(scene, scenario.props[body - n], pose, faded(color, 0.2))
        draw_prop(scene, scenario.props[body - n], pose, color, hollow=True)
    elif scenario.animation.show_real_shape:
        draw_robot(scene, scenario.robots[body], pose, faded(color, 0.2), faded(color, 0.0))
        draw_robot(scene, scenario.robots[body], pose, None, faded(color, 0.7))
    else:
        scene.circle(pose[:2], 0.0, stroke=faded(color, 0.7), pixels=5.0)
