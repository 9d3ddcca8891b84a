"""Straight chase, a model answer: at which ratio good aim is worth half of the time.

1. Across, phi = pi / 2, pure pursuit takes r / (1 - g^2) / v and constant bearing
   r / sqrt(1 - g^2) / v. That is twice as long where sqrt(1 - g^2) = 1/2, at g = 0.866.
2. Away, phi = 0: both take r / (1 - g) / v, and go the same way. No law is quicker.
3. Each point of the circle of Apollonius is reached by both at the same time. The farthest is
   straight ahead, at r g / (1 - g) from the evader: so it should run away.
4. Below: the evader runs across at g = 0.866, and the red one keeps its bearing. For points the
   share is 1/2; for discs a little more, as pure pursuit gains more by its width.
"""

from math import pi, sqrt

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("straight_chase")


def scenario(seed: int = 0):
    return base.scenario(sqrt(3) / 2, pursuer="pursuers/bearing.py", seed=seed)


def checks(record):
    yield from base.checks(record)
    r, d, g = abs(complex(*record.pose[0, :2, 0])), base.theory.touch(record), sqrt(3) / 2
    pure, bearing = (base.theory.duration(r, pi / 2, d, g, 0.5, law) for law in (True, False))
    time = record.scenario.addons[0].outcome(record).capture_time
    yield Prediction("share of pure pursuit's time", bearing / pure, time / pure, 0.02)
