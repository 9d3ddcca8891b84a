"""Formation, the model answer: a circle that turns, for robots that learn of it by their clocks.

1. Circle, wedge and row fade at 0.150, 0.151 and 0.151 1/s: the shape does not matter, since only
   differences from it are in the law. Nor does `pace`, which all have.
2. RING[0, 5] = RING[5, 0] = 0 cuts the ring open. A path of six has l = 2 - 2 cos(pi / 6) = 0.268,
   so 0.0402 1/s is predicted; measured 0.0402, with --stop-time 100.
3. RING = 1 - np.eye(6): all see all, l = 6 and the rate 0.9 1/s; measured 0.913. At the start the
   robots are asked for more than their wheels can do. That shortens the way, and is soon over.
4. This file: places d turn at `spin` [rad/s], and nothing in u says so. A circle of six is itself a
   pattern of the ring's second eigenvalue, l = 1: in complex numbers h' = gain (d - h), and d turns
   as exp(i spin t). So h = d / (1 + i spin / gain): the circle shrinks to gain / sqrt(gain^2 +
   spin^2), 0.832 m, and is late by atan(spin / gain), 33.7 degrees. With d' added to u neither is.
"""

from functools import partial
from math import atan2, cos, degrees, hypot, sin

import numpy as np

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("formation")
SHAPE = np.array(base.SHAPES["circle"])


def turned(angle):
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]]) @ SHAPE


def join(gain, spin, robot):
    return base.join(turned(spin * robot.time), gain, 0.0, robot)


def scenario(spin: float = 0.1, gain: float = 0.15):
    law, plain = partial(join, gain, spin), base.scenario("circle", gain)
    robots = [robot.replace(controller=law) for robot in plain.robots]
    title = "Formation that turns"
    return plain.replace(title=title, robots=robots, addons=plain.addons[:1], stop_time=90.0)


def checks(record):
    gain, spin = record.scenario.robots[0].controller.args
    h = base.aim(record.pose[-1], 0.0)
    x, y = h - h.mean(axis=1, keepdims=True)
    wanted = turned(spin * record.time[-1])
    late = np.arctan2(x * wanted[1] - y * wanted[0], x * wanted[0] + y * wanted[1])
    radius = gain / hypot(gain, spin)
    yield Prediction.within("radius", radius, np.hypot(x, y).mean(), 2, "m")
    yield Prediction("late by", degrees(atan2(spin, gain)), np.degrees(late).mean(), 1, "degrees")
