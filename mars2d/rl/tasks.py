"""The environments that are registered with gymnasium: pursuit, push and sumo.

Each is a function that makes an `Environment`, or with ``num_envs`` a `VectorEnvironment`; more
arguments are passed on to it.
"""

from __future__ import annotations

from math import hypot
from typing import Any

from mars2d.bodies import Box, Holonomic
from mars2d.core.plane import Outline
from mars2d.rl.environment import Environment
from mars2d.rl.episode import Source
from mars2d.rl.vector import VectorEnvironment
from mars2d.scenario.random_starts import RandomStarts
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.world.views import RobotView
from mars2d.world.world import World


def _made(experiment: Source, robot: str | int, **given: Any) -> Environment | VectorEnvironment:
    kind = VectorEnvironment if "num_envs" in given else Environment
    return kind(experiment, robot, **given)


def _rectangle(left: float, right: float, low: float, high: float) -> Outline:
    return ((left, low), (right, low), (right, high), (left, high))


def _gain(robot: RobotView, now: float) -> float:
    """Return by how much a number has fallen since the last step; 0 in the first one."""
    before = getattr(robot.memory, "before", now)
    robot.memory.before = now
    return before - now


def _nearer(world: World, robot: RobotView) -> float:
    """Return the metres that a pursuer came nearer in the last step; 10 more for a capture."""
    x, y = world.pose[:2, 0] - world.pose[:2, 1]
    return _gain(robot, hypot(x, y)) + 10 * len(world.addons.game.results)


def pursuit(**given: Any) -> Environment | VectorEnvironment:
    """Return the game `corner_game`, in which the pursuer learns, 1.2 times as fast as the evader.

    Observation (6,), action (vx, vy), 60 s. Reward: the metres that it comes nearer, 10 for the
    capture.
    """
    apart = RandomStarts(area=_rectangle(-4, 4, -4, 4), least_distance=4, heading=0)
    drawn = {"seed": 0, "random_starts": [apart]}  # quicker than by the example's function
    options = {"stop_time": 60.0, "mu": 1.2, **drawn, **given.pop("options", {})}
    return _made("corner_game", "pursuer", **{"reward": _nearer, "options": options, **given})


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


def push(**given: Any) -> Environment | VectorEnvironment:
    """Return an environment in which a robot pushes a box to a goal on its right, within 30 s.

    Both start at random places, the robot on the left. Observation (8,), action (vx, vy). Reward:
    the metres that the box comes nearer to its goal, a tenth of those that the robot comes nearer
    to the box, 10 at the goal.
    """
    scenario = Scenario(
        title="Push",
        robots=[Robot(name="pusher", diameter=0.3, drive=Holonomic())],
        props=[Box(name="box", length=0.4, width=0.4, mass=0.5)],
        random_starts=[
            RandomStarts(["pusher"], area=_rectangle(-1.8, -1, -1, 1), heading=0),
            RandomStarts(["box"], area=_rectangle(-0.5, 0.5, -0.5, 0.5), heading=0),
        ],
        workspace=_rectangle(-2, 2, -2, 2),
        on_exit="wall",
        stop_time=30.0,
    )
    return _made(scenario, 0, **{"reward": _to_the_goal, **given})


def _shoving(world: World, robot: RobotView) -> float:
    """Return the metres that blue went outwards, half of those that red came nearer to it.

    It is 10 more if red has won, and 2 less if blue has.
    """
    (x, u), (y, v) = world.pose[:2].tolist()
    result = {"red": 10.0, "blue": -2.0}.get(world.addons.ring.winner or "", 0.0)
    return _gain(robot, 0.5 * hypot(u - x, v - y) - hypot(u, v)) + result


def sumo(**given: Any) -> Environment | VectorEnvironment:
    """Return the example `sumo`, in which red learns against the law `dodger`, for 20 s.

    Both start at random places, and decide every 0.1 s. Observation (8,), action (v, omega).
    Reward: the metres that blue goes outwards, half of those that red comes nearer to it, 10 for a
    win and -2 for a defeat.
    """
    inside = RandomStarts(area=_rectangle(-0.9, 0.9, -0.9, 0.9), least_distance=0.8)
    options = {"sampling_time": 0.1, "random_starts": [inside], **given.pop("options", {})}
    return _made("sumo", "red", **{"reward": _shoving, "options": options, **given})
