"""Hide and seek, a model answer: a slim seeker need be only a little quicker.

1. acos(1.5 / 2.05) + acos(1.5 / 1.75) = 1.29 rad: the chord that just touches the pillar.
2. At mu = 1.15 < 2.05 / 1.75 = 1.17 the hider gains on the seeker, and is never seen. At 1.2 it
   loses 0.007 rad/s, which takes 200 s and more; at 1.3 it is seen after 48 s.
3. On a circle of 3.3 m the seeker sees more, 1.64 rad, but needs mu = 1.89 to gain: `wide` loses.
4. Below, a seeker as slim as the hider runs on the hider's own circle, at mu = 1.2.
"""

from math import acos, atan2, cos, hypot, pi, sin

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("hide_and_seek")
PILLAR, NEAR = 1.5, 1.75  # m, and the circle on which both run


def seek(robot):
    x, y, _ = robot.sense.pose
    heading = atan2(y, x) + pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - NEAR))
    return 100 * cos(heading), 100 * sin(heading)


def scenario(seed: int = 0):
    plain = base.scenario(mu=1.2, seed=seed)
    red, blue = plain.robots
    return plain.replace(robots=[red.replace(diameter=0.4, controller=seek).at(NEAR, 0), blue])


def checks(record):
    angle = atan2(*record.pose[0, 1::-1, 1]) - 2 * acos(PILLAR / NEAR)
    free = angle * NEAR / (0.2 * base.SPEED)
    yield Prediction("the hider is not seen for", free, record.time[-1], 1.0, "s")
