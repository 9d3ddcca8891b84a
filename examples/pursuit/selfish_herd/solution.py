"""The selfish herd, a model answer: on a ring the gaps beside you are your risk.

1. With twice as many the risk of one is half. How many are eaten in 30 s changes little: the
   predator is as quick as before, and has to run to the next one.
2. Who is at the edge has a large cell, who is in the middle a small one, in which a predator seldom
   appears. So Hamilton's animals go to the middle, and the flock gets denser.
3. `stray` looks for the one with nobody beside it, and has a longer way to it.
4. On a ring, Hamilton's pond, the domain of one is half of each gap beside it. Below, eight stand
   on a ring with gaps of 30 to 60 degrees, and the predator appears in the largest one, from 120
   to 180 degrees, at 152 degrees: nearer to the fifth, which is caught.
"""

from math import cos, radians, sin

from mars2d.scenario import open_module

base = open_module("selfish_herd")
ANGLES = (0, 30, 75, 120, 180, 225, 270, 315)  # degrees


def scenario():
    plain = base.scenario(number=len(ANGLES), wanted=1)
    wolf, *sheep = plain.robots
    ring = [(2 * cos(radians(a)), 2 * sin(radians(a))) for a in ANGLES]
    team = [one.at(*place) for one, place in zip(sheep, ring, strict=True)]
    wolf = wolf.at(4 * cos(radians(152)), 4 * sin(radians(152)))
    return plain.replace(robots=[wolf, *team])


checks = base.checks
