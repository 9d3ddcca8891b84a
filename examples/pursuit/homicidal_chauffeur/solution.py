"""Homicidal chauffeur, a model answer: who steps aside too late gets less far.

1. For g = 0.5 the formula gives 0.1278 R = 0.256 m; the run shows 0.265 m, since the car sees the
   step one control step later.
2. For small g it is g^2 / 2: half the speed needs a quarter of the width.
3. At g = 1 it would be pi / 2 - 1 = 0.571 radii: a car wider than that needs no speed, only room.
4. From y ahead, with both as hard as they can, the pedestrian is g t - 1 + cos t aside and
   y - sin t ahead after t, in radii and radii per speed. The least distance over t is 0.21 m for
   y = 0.6 g, 0.256 m for y = g. From farther away the car need not turn as hard as it can.
"""

from math import cos, hypot, sin

import numpy as np

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("homicidal_chauffeur")
RATIO, LATE = 0.5, 0.6  # of the speeds; how far ahead, in shares of the best


def late(robot):
    side = None
    while True:
        car = robot.neighbours[0]
        x, y = robot.position - car.position
        c, s = cos(car.pose[2]), sin(car.pose[2])
        near = c * x + s * y > 0 and hypot(x, y) < LATE * RATIO * base.RADIUS
        if not near:
            side = None
        elif side is None:
            side = (-100 * s, 100 * c) if c * y - s * x >= 0 else (100 * s, -100 * c)
        yield side or (0, 0)


def scenario(seed: int = 0):
    given = base.scenario(RATIO, reach=0.105, seed=seed)
    car, person = given.robots
    return given.replace(robots=[car, person.replace(controller=late)], stop_time=7)


def checks(record):
    t = np.linspace(0, 1.5, 1000)
    gap = np.hypot(RATIO * t - 1 + np.cos(t), LATE * RATIO - np.sin(t)).min()
    apart = np.hypot(*np.diff(record.pose[:, :2], axis=2)[..., 0].T).min()
    yield Prediction("first pass", max(gap * base.RADIUS, 0.105), apart, 0.04, "m")
