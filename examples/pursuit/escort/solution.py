"""Escort, a model answer: the guard of a prey that walks has to be quicker by its walk.

1. b / D is 0.42 / 0.82 = 0.51. In the run the guard wins from mu = 0.52 to 0.55 on, by the seed:
   its law sees the hunter a control step late.
2. With bodies of 0.3 m and b = 0.42 m it is 0.42 / 0.72 = 0.58: the guard is farther out than it
   need be, and has the longer way. At b = 0.32 m it is 0.52.
3. With `physics` = "ideal" the hunter runs through the guard; with "stop" both stand still where
   they would touch, and the guard, who wants to go aside, is held by the prey behind it.
4. In the frame of a prey that walks at u, the hunter goes v + u at most, and the guard mu v - u at
   least: mu > (u + (v + u) b / D) / v is enough. Below, u = 0.05 m/s: 0.66; the guard goes at 0.75.
"""

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("escort")
WALK = 0.05  # m/s


def walk(_):
    return WALK, 0.0


def scenario(mu: float = 0.75, seed: int = 0):
    plain = base.scenario(mu=mu, seed=seed)
    hunter, guard, prey = plain.robots
    return plain.replace(robots=[hunter, guard, prey.replace(controller=walk)])


def checks(record):
    hunter, guard, _ = (robot.drive.max_linear_speed for robot in record.scenario.robots)
    enough = (WALK + (hunter + WALK) * base.theory.ratio(record)) / hunter
    yield Prediction("the prey is free", int(guard / hunter > enough), base.survives(record), 0)
