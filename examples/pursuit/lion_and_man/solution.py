"""Lion and man, a model answer: a lion that starts on the man's radius has so much less to do.

1. At R = 3.6 m, (R / v) asin(1 - c / R) is 6.4 s for c = 0.8 m and 8.9 s for 0.2 m; for a point it
   is pi R / (2 v) = 11.3 s, and no more, however small c is.
2. From half the radius Besicovitch's man lasts 6.6, 7.8, 8.8 and 9.7 s for 0.4, 0.2, 0.1 and
   0.05 m: about a second more for each half. On the circle it is 3.7, 4.5, 5.0 and 5.4 s.
3. Straight at a man on a circle the lion runs behind him: the gap closes ever more slowly.
4. From r0 on his radius it is (R / v) (asin(1 - c / R) - asin(r0 / R)). Below, r0 = 2 m.
"""

from math import asin, hypot

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("lion_and_man")
START = 2.0  # m, from the middle


def scenario(seed: int = 0):  # the lion on the man's radius
    given = base.scenario(seed=seed)
    lion, man = given.robots
    x, y, _ = man.pose
    share = START / hypot(x, y)
    return given.replace(robots=[lion.at(share * x, share * y), man])


def checks(record):
    reach, far = record.scenario.robots[0].diameter, hypot(*record.pose[0, :2, 1])
    meal = far / base.SPEED * (asin(1 - reach / far) - asin(START / far))
    time = record.scenario.addons[0].outcome(record).capture_time
    yield Prediction("meal", meal, time, 0.1, "s")
