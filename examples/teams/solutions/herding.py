"""Herding, a model answer: a dog that goes round the flock may start anywhere.

1. It collects for 19 s, until the flock is within 2.32 m of its middle, then drives, all in 65 s.
2. 30 of 30 flocks come in with 1, 5, 10, 20 and 30 sheep, in 49 s (the median) for one, and in 66
   to 71 s for the others: the dog moves a flock, not sheep, and more sheep only make it wider.
3. With FEAR = 2 m only 15 of 30 come in within 300 s: who is out of reach grazes, and a dog that
   drives the near ones leaves the far ones behind. At 3 m all 30 do, in 94 s; at 8 m in 60 s.
4. From (4, -1), between flock and pen, the law of the lesson drives the flock away first: 29 of 30
   come in, in 138 s. Below, the dog keeps out of a circle round the flock until it is where it has
   to be, always the same way round: who takes the shorter way may change sides again and again. So
   30 of 30 come in, in 117 s.
"""

import numpy as np

from mars2d.scenario import open_module

base = open_module("herding")
CLOSE, FEAR, SLOW, FAST, PEN, unit = (
    base.CLOSE, base.FEAR, base.SLOW, base.FAST, base.PEN, base.unit
)  # fmt: skip


def control(world, ahead=0.0):
    while min(world.position[0, 1:]) < base.GATE:
        dog, flock = world.position[:, :1], world.position[:, 1:]
        to, middle = flock[:, None] - flock[:, :, None], flock.mean(axis=1)[:, None]
        crowd = (unit(to) * (np.hypot(*to) < CLOSE)).sum(axis=2)
        wish = 1.05 * unit(middle - flock) - 2 * unit(crowd) + unit(flock - dog)
        chance, apart = world.rng.normal(size=flock.shape), np.hypot(*(flock - dog))
        ahead = unit(0.5 * ahead + wish + 0.3 * unit(chance)) * (apart < FEAR)
        out = np.hypot(*(flock - middle))
        stray, radius = flock[:, [out.argmax()]], CLOSE * out.size ** (2 / 3)
        goal = middle + CLOSE * out.size**0.5 * unit(middle - PEN)
        if max(out) > radius:
            goal = stray + CLOSE * unit(stray - middle)
        way = round_about(dog - middle, goal - dog, max(out) + FEAR / 2)
        speed = FAST if min(apart) > 3 * CLOSE else 0.3 * SLOW
        yield np.hstack([speed * unit(way), SLOW * ahead])
    world.stop(f"all are in the pen after {world.time:g} s")


def round_about(place, way, radius):
    """Return which way to go: straight, or where the flock is in between, round it.

    place: (2, 1) of the dog, from the flock's middle. way: (2, 1), to its goal. radius: of the
    circle round the flock that it keeps out of.
    """
    aside = unit(np.array([-place[1], place[0]]))
    behind = (unit(place) * unit(place + way)).sum() > 0.7  # it stands where it has to
    return way if behind else aside + unit(place) * (radius - np.hypot(*place))


def scenario(flock: int = 10, start: int = 1):
    given = base.scenario(flock, start)
    dog, *sheep = given.robots
    return given.replace(robots=[dog.at(4, -1), *sheep])


checks = base.checks
