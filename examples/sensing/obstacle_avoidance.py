"""Obstacle avoidance: robots with lasers wander about a hall, and none touches anything.

Setting: distributed, sensors only: each robot sees how far its 180 beams go, and nobody talks.
Law: a robot that goes on by s comes nearer by s cos(b) to what a beam has met at the bearing b. So
with d left in front of each beam there is room for s = min d / cos(b), over the beams ahead. It
uses that up at no more than s / horizon, and turns to where s is longest, best ahead (the free
directions of the vector field histogram: Borenstein and Koren, IEEE TRA 7(3), 1991).
Question: they all move. How can they be safe without knowing what the others do?
Prediction: if each uses up no more than half of what is free in a sampling time T, two together
use up no more than all of it (each takes half of the care: van den Berg et al., ICRA 2008). So from
horizon = 2 T on nothing ever touches, and GAP is left, but for the noise of lasers.
"""

from functools import partial
from math import cos, pi, sin

import numpy as np
from scipy.spatial.distance import pdist

from mars2d import Animation, InputError, Prediction, Robot, Scenario
from mars2d.addons import Map
from mars2d.sensors import RangeFinder

SPEED, GAP = 0.5, 0.05  # m/s, m
LASER = RangeFinder(beams=180, range=3.0, noise=0.005)
WAYS = LASER.angles[::10]  # the directions that are thought of, relative to the heading
CLOSING = np.cos(LASER.angles - WAYS[:, None]).clip(0)
AHEAD, LIKED = len(WAYS) // 2, 1.2 + np.cos(WAYS)


def wander(robot, horizon):
    left = (robot.sense.range_finder - robot.radius - GAP).clip(1e-3, LASER.range)
    room = 1 / (CLOSING * (1 / left)).max(axis=1)  # m, in each direction
    return min(SPEED, room[AHEAD] / horizon), 2 * WAYS[np.argmax(LIKED * room)]


def scenario(robots: int = 20, horizon: float = 1.0):
    if robots not in range(2, 41):
        raise InputError(f"robots = {robots}: expected 2 to 40, as many as there are places")
    robot = Robot(sensors=[LASER], controller=partial(wander, horizon=horizon), sees="sensors")
    corners = [(0.4 * cos(pi * k / 3), 0.4 * sin(pi * k / 3)) for k in range(6)]
    posts = [(-3.0, 0.9), (-0.6, -2.7), (1.8, 2.7), (3.0, -0.9)]
    return Scenario(
        title="Obstacle avoidance",
        robots=[robot.at(1.2 * (k // 5) - 4.2, 1.8 * (k % 5) - 3.6, k) for k in range(robots)],
        on_exit="wall",
        stop_time=60.0,
        addons=[Map([[(x + dx, y + dy) for dx, dy in corners] for x, y in posts])],
        animation=Animation(playback_speed=2),
    )


def checks(record):
    size = record.scenario.robots[0].diameter
    apart = min(pdist(pose[:2].T).min() for pose in record.pose) - size
    yield Prediction("collisions", 0, record.collisions, 0)
    yield Prediction("robots nearer to each other than GAP, by", 0, max(GAP - apart, 0), 0.02, "m")
    way = np.hypot(*np.diff(record.pose[:, :2], axis=0).swapaxes(0, 1)).cumsum(axis=0)  # m
    slow = (np.diff(way[::50], axis=0) < 0.5).any(axis=0)  # in any 5 s
    yield Prediction("robots that come to a stop", 0, slow.sum(), 0)
