"""Collective circular motion, the model answer: round the beacon to the right.

1. v = 0.7 x 0.63 ln(1.12 / 0.84) pi / 2 = 0.199 m/s, so a round takes 2 pi 0.7 / v = 22.1 s. They
   turn at 0.282 rad/s, as measured over the last 20 s: 22.2 s.
2. Three robots see up to 60 degrees to each side, and D_0 to the next one on the circle is nearer:
   2 asin(D_0 / (2 radius)) = 97.2 degrees. Then the last one has a gap of 360 - 2 x 97.2 = 165.6
   before it: 166.0 after 300 s. Four on a circle of 0.85 m leave one of 131.1, and do: 131.1. On
   one of 0.9 m two lose sight of the next one: gaps of 117.9 and 99.3 instead of one of 145.9.
3. In even gaps the next robot is at the edge of the view. Seen from nearer than D_0 it turns one
   out of the circle, until it is out of view again: four see somebody for 49 % of the time, and go
   at 0.706 m, six at 0.726 m, and not at 0.700 m. Views that are 5 % narrower leave room: 0.700 m
   for both, but the gaps are up to 101 and 64.8 degrees, and not 90 and 60.
4. This file: alpha is taken from -PSI to 2 pi - PSI, the mirror image of the law. The same circle
   is gone round to the right. The neighbours' bearings have a sign: nothing changes there.
"""

from functools import partial
from math import pi

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("circular_motion")


def circle(radius, k_b, k_v, robot):
    (rho, alpha, _), seen = robot.sense.beacon["lamp"], {*robot.sense.ahead, *robot.sense.near}
    turn = k_b * base.g(rho, base.RHO_0) * (alpha if alpha < 2 * pi - base.PSI else alpha - 2 * pi)
    turn += k_v * sum(base.g(each.range, base.D_0) * each.bearing for each in sorted(seen))
    return radius * k_b * base.g(radius, base.RHO_0) * pi / 2, turn


def scenario(n=4, radius=0.7, k_b=0.63, k_v=0.75):
    plain, law = base.scenario(n, radius, k_b, k_v), partial(circle, radius, k_b, k_v)
    robots = [robot.replace(controller=law) for robot in plain.robots]
    return plain.replace(title="Circular motion to the right", robots=robots)


def checks(record):
    radius, k_b, _ = record.scenario.robots[0].controller.args
    yield from base.checks(record)
    spin = -k_b * base.g(radius, base.RHO_0) * pi / 2  # v / radius, to the right
    turning = record.command[-200:, 1].mean()
    yield Prediction.within("turning", spin, turning, 3, "rad/s")
