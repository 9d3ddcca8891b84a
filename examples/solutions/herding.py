"""Herding, a model answer: a dog that goes round the flock may start anywhere.

TEXT
"""

import numpy as np

from mars2d.files import open_module

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
