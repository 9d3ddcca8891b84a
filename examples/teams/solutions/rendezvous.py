"""Model answer to the exercises of rendezvous.

1. The way left is below 0.1 m after 21.5 s without losses; after 24.6, 36.7 and 59.3 s with losses
   of 0.5, 0.8 and 0.9, the means of seeds 0 to 7.
2. h = 0.2: z = (0.6 + sqrt(0.36 + 0.8)) / 2 = 0.8385, and 0.8385 is measured. From 1/s on the whole
   team shakes (m = 2), and neighbours against each other (m = -2): 0.10 m is left for ever, and at
   1.2/s the drives' 2 m/s end the growth.
3. The leader listens no more, and the others are a path of five robots whose both ends hear it. Its
   largest eigenvalue is 2 cos(pi / 6), in place of the ring's 2 cos(pi / 3), so that
   z^2 = (1 - 2 h) z + 2 h cos(pi / 6): z = 0.9772, and 0.9772 is measured below. They meet where
   the leader has been all along.
4. For p = 0.5, 0.8 and 0.9 the formula gives 0.9193, 0.9414 and 0.9618; measured, means of seeds 0
   to 7: 0.9193, 0.9431 and 0.9635. A lost message costs little, since the one before says nearly
   the same.
5. lambda is 3 for three in a ring, 6 for a complete graph of six and 2 + sqrt(3) for a path: 2.62,
   1.31 and 2.10 s. More neighbours make robots fast and sensitive alike: without a delay the
   slowest patterns shrink at the rates gain x 3, 6 and 0.27, so the complete graph is the fastest.
"""

from math import cos, pi, sqrt

import numpy as np

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("rendezvous")


def lead(robot):
    robot.send(robot.sense.pose[:2] - base.PLACES[robot.index])
    return 0.0, 0.0


def scenario(loss: float = 0.0):
    one, *others = base.scenario(loss).robots
    team = [one.replace(controller=lead, name="leader"), *others]
    return base.scenario(loss).replace(title="Rendezvous at a leader", robots=team, stop_time=200.0)


def checks(record):
    aims = record.pose[:, :2] - np.transpose(base.PLACES)  # (T, 2, n): where each would meet
    off = np.hypot(*(aims - aims[0, :, :1]).transpose(1, 0, 2)).max(axis=1)  # of the leader's
    yield Prediction("way left at the end", 0.0, off[-1], 0.01 * off[0], "m")
    if record.scenario.addons[0].loss == 0:
        h = base.GAIN * record.scenario.sampling_time
        z = (1 - 2 * h + sqrt((1 - 2 * h) ** 2 + 8 * h * cos(pi / 6))) / 2
        a, b = np.searchsorted(record.time, [50, 100])
        yield Prediction("its factor a step", z, (off[b] / off[a]) ** (1 / (b - a)), 1e-3)
