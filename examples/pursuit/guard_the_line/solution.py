"""Guard the line, a model answer: two guards stop an attacker that gets past each of them.

1. The lowest point is at the same y for all x of the guard's that mirror each other: the circle's
   middle lies on the line through both robots, beyond the attacker.
2. At mu = 1 and without a capture distance the region is all that is nearer to the attacker. Its
   edge, the bisector, crosses any line that is not parallel to it: on a line without ends the
   attacker gets past each guard that is not straight below it.
3. At mu = 0.7 from seed 3 the attacker wins with `lowest`, as the formula says, and loses with
   `straight`.
4. What one guard leaves to the attacker the other one may take: its region is now that which it
   reaches before both. Below, all three head for the lowest point of that.
"""

import numpy as np

from mars2d import Prediction
from mars2d.geometry import dominance
from mars2d.scenario import open_module

base = open_module("guard_the_line")


def lowest(attacker, guards):
    """The lowest point that an attacker reaches before all guards."""
    ways = [dominance(attacker, at, 0.7, base.CAPTURE).T - attacker for at in guards]
    nearest = np.argmin([(way**2).sum(axis=1) for way in ways], axis=0)
    edge = np.array(ways)[nearest, np.arange(360)] + attacker
    return edge[edge[:, 1].argmin()]


def control(world):
    *guards, attacker = world.position.T
    goal = lowest(attacker, guards)
    return 100 * (goal - world.position.T).T


def scenario():
    plain = base.scenario(mu=0.7, seed=3)
    red, blue = (robot.replace(controller=None) for robot in plain.robots)
    other = red.replace(name="orange").at(-red.pose[0], red.pose[1])
    game, *_ = plain.addons
    game = game.replace(roles={"guard": ["red", "orange"], "attacker": ["blue"]})
    return plain.replace(robots=[red, other, blue], addons=[game], sees="positions")


def checks(record):
    *guards, attacker = record.pose[0, :2].T
    alone, both = (lowest(attacker, some)[1] for some in (guards[:1], guards))
    yield Prediction("one guard alone would be passed", 1, int(alone < base.LINE), 0)
    yield Prediction(
        "height above the line", both - base.LINE, record.pose[-1, 1, 2] - base.LINE, 0.05, "m"
    )
