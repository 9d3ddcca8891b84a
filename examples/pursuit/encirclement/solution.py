"""Encirclement, a model answer: how many it takes for less than half of the speed.

1. pi / asin(0.9) = 2.8, so three will do; at 0.8 it is 3.4: four.
2. At g = 1, asin g is a right angle: a gap of half a turn is still closed, which says that the
   evader is in the convex hull.
3. At g = 0.8 and even gaps, b = 60 degrees: 3 m sin(60 - 53.1 degrees) = 0.36 m; as bodies of 0.2 m
   they would have to be 0.36 m wide.
4. pi / asin(0.45) = 6.7: seven. Below, seven at even gaps catch one that runs straight.
"""

from math import asin, ceil, pi

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("encirclement")
RATIO = 0.45


def scenario(seed: int = 0):
    return base.scenario(n=ceil(pi / asin(RATIO)), ratio=RATIO, uneven=0.0, seed=seed)


def checks(record):
    yield Prediction("pursuers", 7, len(record.scenario.robots) - 1, 0)
    caught = record.scenario.addons[0].outcome(record).captures
    yield Prediction("captures", 1, len(caught), 0)
