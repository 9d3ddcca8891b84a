"""A leader drives its round; followers keep behind the one before (mixed laws).

Setting: distributed. The leader's law is a generator, which keeps its own memory: it drives the
sides of a square and turns at its corners. Each follower steers towards the robot before it with
v = k (d - d0), omega = k_a a, where d is the distance, d0 the one to keep, and a the bearing.
"""

from math import atan2, cos, hypot, pi
from typing import Annotated

from mars2d import Animation, Range, Robot, Scenario
from mars2d.geometry import wrap

SPEED, SIDE, GAP = 0.4, 5.0, 0.6


def lead(robot):
    """Drive a square for ever: a generator yields one command a step."""
    while True:
        start = robot.pose[:2]
        while hypot(*(robot.pose[:2] - start)) < SIDE:
            yield SPEED, 0.0
        heading = robot.pose[2] + pi / 2
        while robot.pose[2] < heading - 1e-6:
            yield SPEED / 2, pi / 6


def follow(robot):
    """Keep GAP behind the robot before: a function is called at each step."""
    before = robot.neighbours[robot.index - 1]
    dx, dy = before.pose[:2] - robot.pose[:2]
    bearing = wrap(atan2(dy, dx) - robot.pose[2])
    return 1.5 * (hypot(dx, dy) - GAP) * cos(bearing), 2.0 * bearing


def scenario(followers: Annotated[int, Range(1, 8)] = 4):
    leader = Robot(name="leader", pose=(-2.5, -3, 0), controller=lead, color="#d55e00")
    team = [
        Robot(name=f"follower{k}", pose=(-2.5 - GAP * k, -3, 0), controller=follow)
        for k in range(1, followers + 1)
    ]
    return Scenario(
        title="Follow the leader",
        robots=[leader, *team],
        workspace=[(-8, -5), (-8, 5), (5, 5), (5, -5)],
        stop_time=120.0,
        animation=Animation(playback_speed=5, base_colors=["#0072b2"]),
    )
