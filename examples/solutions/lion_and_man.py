"""Lion and man, a model answer: a lion that starts on the man's radius has so much less to do.

1. (R / v) asin(1 - c / R) is 7.42 s for c = 0.8 m, 10.03 s for 0.2 m; for a point it is
   pi R / (2 v) = 12.57 s, and no more, however small c is.
2. Besicovitch's man lasts 6.6, 7.9, 8.8 and 9.8 s for 0.4, 0.2, 0.1 and 0.05 m: a second more for
   each half, without end. On the edge he gets less and less.
3. Straight at a man on the edge the lion runs behind him for ever: the gap closes ever more slowly.
4. From r0 on his radius it is (R / v) (asin(1 - c / R) - asin(r0 / R)). Below, r0 = 2 m.
"""

from math import asin, hypot

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("lion_and_man")
START = 2.0  # m, from the middle


def scenario(seed: int = 0):
    given = base.scenario(seed=seed)
    lion, man = given.robots
    x, y, _ = man.pose
    share = START / hypot(x, y)
    return given.replace(robots=[lion.at(share * x, share * y), man])


def checks(record):
    meal = asin(1 - record.scenario.robots[0].diameter / base.RADIUS) - asin(START / base.RADIUS)
    time = record.scenario.addons[0].outcome(record).capture_time
    yield Prediction("meal", meal * base.RADIUS / base.SPEED, time, 0.1, "s")
