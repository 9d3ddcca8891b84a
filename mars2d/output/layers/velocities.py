"""How fast everything moves, as arrows, and the circles that robots can't turn into."""

from __future__ import annotations

import numpy as np

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.arrows import (
    EDGE,
    LONGEST,
    Ruler,
    arrow,
    as_read,
    crowd_factor,
    shortening,
    usual_length,
)
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

VELOCITY = "#00695c"
ARROW_WIDTH = 3.2  # points

SLOWEST = 0.01
"""Slower bodies, in shares of the fastest drive's bound, have no arrow."""

CROWD = 30
"""With more bodies, arrows have no edge."""

TIGHTEST = faded(VELOCITY, 0.45)
"""The colour of the circles of the least turning radius."""


def speed_scale(scenario: Scenario) -> Ruler:
    """Return the scale of an experiment: the fastest drive's bound is two robots long."""
    length, crowd = usual_length(scenario, 2.0, 0.08), crowd_factor(scenario) ** 0.5
    fastest = max(robot.drive.max_linear_speed for robot in scenario.robots)
    width, unit = ARROW_WIDTH / crowd**0.5, length / fastest / crowd
    longest = LONGEST * length / crowd
    return Ruler(VELOCITY, width, unit, longest, lambda speed: f"{as_read(speed)} m/s", fastest)


def velocities(frame: Frame) -> Scene:
    """Return the mean velocities of the control step that led to a frame.

    An arrow goes from the middle of a body to where it would be after some time, the same for all.
    Below, two circles show how tightly a robot can turn at its speed, where its drive bounds this.
    """
    scene, velocity = Scene(), frame.velocity
    if len(frame.scenario.robots) <= CROWD:
        _tightest_turns(scene, frame)
    scale = speed_scale(frame.scenario)
    poses = frame.all_poses
    speed = np.hypot(velocity[0], velocity[1])
    moving = np.flatnonzero(speed >= SLOWEST * scale.most)
    shorter = shortening(scale.unit * speed[moving], scale.longest)
    ways = scale.unit * shorter * velocity[:2, moving]
    edge = EDGE if len(speed) <= CROWD else None
    for tail, way, factor in zip(poses[:2, moving].T, ways.T, shorter, strict=True):
        arrow(scene, tail, way, fill=VELOCITY, width=scale.width, edge=edge, shortened=factor < 1)
    return scene


def _tightest_turns(scene: Scene, frame: Frame) -> None:
    """Draw the circles of the least radius, left and right of each robot that has one."""
    for i, robot in enumerate(frame.scenario.robots):
        x, y, theta = frame.pose[:, i].tolist()
        radius = robot.drive.turning_radius(float(np.hypot(*frame.velocity[:2, i])))
        for side in (-radius, radius) if radius else ():
            center = x - side * np.sin(theta), y + side * np.cos(theta)
            scene.circle(center, radius, stroke=TIGHTEST, width=1.0)
