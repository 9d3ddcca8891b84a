"""The environments that are registered with gymnasium: pursuit, push, sumo and coverage.

Each is a function that makes an `Environment`; more arguments are passed on to it.
"""

from __future__ import annotations

from math import hypot
from typing import Any

import numpy as np

from mars2d.addons import Voronoi
from mars2d.bodies import Box, Holonomic
from mars2d.rl.environment import Environment
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.world.views import RobotView
from mars2d.world.world import World

__all__ = ["coverage", "pursuit", "push", "sumo"]


def _gain(robot: RobotView, now: float) -> float:
    """Return by how much a number has fallen since the last step; 0 in the first one."""
    before = getattr(robot.memory, "before", now)
    robot.memory.before = now
    return before - now


def _nearer(world: World, robot: RobotView) -> float:
    """Return the metres that a pursuer came nearer in the last step; 10 more for a capture."""
    x, y = world.pose[:2, 0] - world.pose[:2, 1]
    return _gain(robot, hypot(x, y)) + 10 * len(world.addons.game.captures)


def pursuit(**given: Any) -> Environment:
    """Return the game `corner_game`, in which the pursuer learns, 1.2 times as fast as the evader.

    Observation (6,), action (vx, vy), 60 s. Reward: the metres that it comes nearer, 10 for the
    capture.
    """
    options = {"stop_time": 60.0, "mu": 1.2, **given.pop("options", {})}
    return Environment("corner_game", "pursuer", **{"reward": _nearer, "options": options, **given})


GOAL = (1.5, 0.0)
"""Where the box shall be, m."""

NEAR = 0.2
"""How near its middle has to come, m."""


def _to_the_goal(world: World, robot: RobotView) -> float:
    """Return the metres that the box came nearer to the goal, and a tenth of the robot's to it."""
    (x, y), (u, v) = world.prop_pose[:2, 0].tolist(), world.pose[:2, 0].tolist()
    left = hypot(x - GOAL[0], y - GOAL[1])
    if left < NEAR:
        world.stop(f"the box is at its goal after {world.time:g} s")
    return _gain(robot, left + 0.1 * hypot(x - u, y - v)) + 10 * (left < NEAR)


def push(**given: Any) -> Environment:
    """Return an environment in which a robot pushes a box 1.5 m to the right, within 30 s.

    Observation (8,), action (vx, vy). Reward: the metres that the box comes nearer to its goal, a
    tenth of those that the robot comes nearer to the box, 10 at the goal.
    """
    scenario = Scenario(
        title="Push",
        robots=[Robot(pose=(-1.5, 0.4, 0), diameter=0.3, drive=Holonomic())],
        props=[Box(length=0.4, width=0.4, mass=0.5)],
        workspace=[(-2, -2), (2, -2), (2, 2), (-2, 2)],
        on_exit="wall",
        stop_time=30.0,
    )
    return Environment(scenario, **{"reward": _to_the_goal, **given})


def _shoving(world: World, robot: RobotView) -> float:
    """Return the metres that the other was shoved outwards; 10 for a win, -10 for a defeat."""
    ring = world.addons.ring
    x, y = world.pose[:2, 1].tolist()
    result = {"red": 10.0, "blue": -10.0}.get(ring.winner or "", 0.0)
    return _gain(robot, -hypot(x, y)) + result


def sumo(**given: Any) -> Environment:
    """Return the example `sumo`, in which red learns against the law `dodger`, for 20 s.

    Observation (8,), action (v, omega). Reward: the metres that blue is shoved outwards, 10 for a
    win and -10 for a defeat.
    """
    return Environment("sumo", "red", **{"reward": _shoving, **given})


def _centroid(robot: RobotView) -> tuple[float, float]:
    """Lloyd's law: go to the centroid of the robot's Voronoi cell."""
    x, y = robot.world.addons.voronoi.centroids[:, robot.index] - robot.position
    return x, y


def _covering(world: World, robot: RobotView) -> float:
    """Return by how much the cost of coverage H has fallen in the last step, m^4."""
    return _gain(robot, world.addons.voronoi.cost)


def coverage(**given: Any) -> Environment:
    """Return an environment in which one of five robots learns to cover a square, for 40 s.

    The others go to the centroids of their Voronoi cells. Observation (20,), action (vx, vy).
    Reward: by how much the cost H of coverage falls, m^4.
    """
    robot = Robot(diameter=0.15, drive=Holonomic(), controller=_centroid)
    x, y = np.array([[0.4, 0.8, 1.2, 0.4, 0.8], [0.4, 0.5, 0.4, 0.8, 0.9]])
    scenario = Scenario(
        title="Coverage",
        robots=[*map(robot.at, x, y)],
        workspace=[(0, 0), (4, 0), (4, 4), (0, 4)],
        on_exit="wall",
        sampling_time=0.2,
        stop_time=40.0,
        addons=[Voronoi()],
    )
    return Environment(scenario, 4, **{"reward": _covering, **given})
