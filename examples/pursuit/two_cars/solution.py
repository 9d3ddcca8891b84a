"""Two cars, a model answer: an evader that bends less than its pursuer is caught.

1. v^2 / R = 0.5 m/s^2, and 0.49 / r is as much at r = 0.98 m.
2. At r = 0.3 m the evader turns round within the pursuer's circle; the way past is 0.29 m.
3. follow steers late: it turns only as the other car is off its nose. It loses up to r = 1 m, while
   lead, which turns four times as quickly as the line of sight, wins from 0.7 m on: the cars are
   0.2 m wide, and that is worth some bend.
4. Below: at r = 1.1 m, beyond 0.98 m, lead catches the evader at the first jink.
"""

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("two_cars")


def scenario(seed: int = 0):
    return base.scenario(radius=1.1, seed=seed)


def checks(record):
    red, blue = (robot.drive for robot in record.scenario.robots)
    bends = [drive.max_linear_speed * drive.max_angular_speed for drive in (red, blue)]
    yield Prediction("bend of the pursuer, less the evader's", 0.5 - 0.49 / 1.1,
                     bends[0] - bends[1], 1e-9, "m/s^2")  # fmt: skip
    caught = record.scenario.addons[0].outcome(record).captures
    yield Prediction("captures", 1, len(caught), 0)
