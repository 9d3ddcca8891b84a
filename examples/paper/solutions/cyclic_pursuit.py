"""Cyclic pursuit, the model answer: robots that run beside the next one, for a radius of choice.

1. n = 4, gain = 0.2: predicted 4 x 0.05 / (0.2 pi) = 0.318 m, measured 0.318 m. With twice the
   speed the circle is twice as large, with twice the gain half as large.
2. A round takes 2 pi radius / speed = 2 n / k_a, 120 s for six, whatever the speed.
3. All go alike: a robot turns by k_a a, and the line to the next one by k_r (sin(2 pi / n - a) +
   sin a) = 2 k_r sin(pi / n) cos(pi / n - a). With the a that makes them equal the gap grows as
   exp(s t), s = k_r (cos(2 pi / n - a) - cos a). For ratio = 2.2 and 3 s is -0.00319 and -0.00651
   1/s; measured -0.00318 and -0.00652, until they touch. For 1.7, speed = 5: 0.00373 and 0.00372.
4. This file: who runs beside the next one, by `aside`, turns at k_a (a - aside), and a = pi / n on
   a circle: its radius is speed / (k_a (pi / n - aside)). With aside = pi / n they go straight on.
"""

from functools import partial
from math import atan2, hypot, pi

import numpy as np

from mars2d import Prediction
from mars2d.geometry import wrap
from mars2d.scenario import open_module

base = open_module("cyclic_pursuit")


def pursue(gain, speed, aside, robot):
    dx, dy = robot.neighbours[0].position - robot.position
    bearing = wrap(atan2(dy, dx) - robot.pose[2])
    return min(speed, gain * hypot(dx, dy)), gain * (bearing - aside)


def scenario(aside: float = -0.3, n: int = 6, gain: float = 0.1, speed: float = 0.05):
    plain = base.scenario(n=n, gain=gain, speed=speed)
    law = partial(pursue, gain, speed, aside)
    robots = [robot.replace(controller=law) for robot in plain.robots]
    return plain.replace(title="Cyclic pursuit, aside", robots=robots, addons=[])


def checks(record):
    (gain, speed, aside), n = record.scenario.robots[0].controller.args, record.pose.shape[2]
    x, y = record.pose[-1, :2] - record.pose[-1, :2].mean(axis=1, keepdims=True)
    radius = speed / (gain * (pi / n - aside))
    yield Prediction.within("radius", radius, np.hypot(x, y).mean(), 1, "m")
    yield Prediction.within("turns at", speed / radius, record.command[-1, 1].mean(), 1, "rad/s")
