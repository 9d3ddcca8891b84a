"""Pursuit round four corners, a model answer: who aims ahead catches with less speed.

1. At mu = 0.5 the pursuer cuts all corners on a small round, 3.7 m from the evader and more; at 0.9
   it follows nearly along the sides, 1.06 m behind at the least.
2. sqrt(1 - mu^2) ((1 - mu) / (1 + mu))^(mu / 2) SIDE = 0.55 m holds for mu = 0.9446. Of ten starts
   each, none led to a capture within 500 s at 0.945, and all ten did at 0.95.
3. For robots of 0.3 m that is 0.9688: the thinner evader is caught by a quicker pursuer only. For
   SIDE = 7 m it is 0.9300: less way to run, so a slower pursuer will do.
4. The law below takes the evader's velocity from two positions, and aims at where the evader will
   be when the pursuer could be where it is now (lead 1). At mu = 0.9 it catches after 49 s, at 0.8
   after 58 s, at 0.78 not within 500 s. With half the lead it does as well; with 0.4 it does not.
"""

from math import atan2, hypot

import numpy as np

from mars2d import Prediction
from mars2d.geometry import wrap
from mars2d.scenario import open_module

base = open_module("pursuit_corners")


def ahead(mu, lead):
    def pursue(robot):
        before = here = robot.neighbours[0].position
        while True:
            here = robot.neighbours[0].position
            velocity = (here - before) / robot.sampling_time
            x, y = here - robot.position
            x, y = (x, y) + velocity * (lead * hypot(x, y) / (mu * base.SPEED))
            yield mu * base.SPEED, wrap(atan2(y, x) - robot.pose[2]) / robot.sampling_time
            before = here

    return pursue


def scenario(mu: float = 0.9, lead: float = 1.0):
    given = base.scenario(mu)
    red, blue = given.robots
    red = red.replace(controller=ahead(mu, lead))
    return given.replace(robots=[red, blue], addons=given.addons[:1])


def checks(record):
    outcome = record.scenario.addons[0].outcome(record)
    yield Prediction("captures", 1, len(outcome.captures), 0)
    apart = np.hypot(*np.diff(record.pose[-1, :2])[:, 0])
    yield Prediction("distance then", record.scenario.robots[0].diameter, apart, 0.01, "m")
