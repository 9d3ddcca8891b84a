"""Herding: one dog brings a flock into a pen that no sheep wants to enter.

Setting: centralised, partial information: one law moves all, by their positions alone.
Law of a sheep: with the dog within FEAR it goes on as before, to the middle of all, away from those
within CLOSE and from the dog, and by chance, by the weights 0.5, 1.05, 2, 1, 0.3. Of the dog: while
all N are within CLOSE N^(2/3) of their middle it drives: it goes to behind the middle, as seen from
the pen. Else it collects: it goes to behind the sheep that is farthest out.
Source: Stroembom et al., J. R. Soc. Interface 11, 20140719, 2014. Lengths and speeds are ours.
Prediction: all come into the pen, and the dog touches none.
"""

import numpy as np

from mars2d import Holonomic, Prediction, Robot, Scenario
from mars2d.addons import Map

CLOSE, FEAR, SLOW, FAST = 0.5, 5.0, 0.2, 0.3  # m, m, m/s of the sheep, m/s of the dog
GATE, PEN = 7.0, np.array([[8.5], [0]])  # x of the gate, the middle of the pen, m
FENCE = np.array([(5, 4), (GATE, 2), (10, 2), (10, -2), (GATE, -2), (5, -4)])  # m


def unit(vectors):
    return vectors / np.maximum(np.hypot(*vectors), 1e-9)


def control(world, ahead=0.0):
    while min(world.position[0, 1:]) < GATE:
        dog, flock = world.position[:, :1], world.position[:, 1:]  # (2, 1), (2, N)
        to, middle = flock[:, None] - flock[:, :, None], flock.mean(axis=1)[:, None]
        crowd = (unit(to) * (np.hypot(*to) < CLOSE)).sum(axis=2)
        wish = 1.05 * unit(middle - flock) - 2 * unit(crowd) + unit(flock - dog)
        chance, apart = world.rng.normal(size=flock.shape), np.hypot(*(flock - dog))
        ahead = unit(0.5 * ahead + wish + 0.3 * unit(chance)) * (apart < FEAR)
        stray = flock[:, [np.hypot(*(flock - middle)).argmax()]]
        goal = middle + CLOSE * apart.size**0.5 * unit(middle - PEN)
        if np.hypot(*(stray - middle)) > CLOSE * apart.size ** (2 / 3):
            goal = stray + CLOSE * unit(stray - middle)
        speed = FAST if min(apart) > 3 * CLOSE else 0.3 * SLOW  # near sheep: gently
        yield np.hstack([speed * unit(goal - dog), SLOW * ahead])
    world.stop(f"all are in the pen after {world.time:g} s")


def scenario(flock: int = 10, start: int = 1):
    lamb = Robot(diameter=0.25, friction=0, drive=Holonomic(max_linear_speed=SLOW), color="gray")
    rex = lamb.replace(name="dog", drive=Holonomic(max_linear_speed=FAST), color="red")
    places = np.random.default_rng(start).permutation([(k // 7 - 2, k % 7 - 3) for k in range(35)])
    return Scenario(
        title="Herding",
        robots=[rex.at(-6, -4), *(lamb.at(*places[k]) for k in range(flock))],
        workspace=None,
        stop_time=300,
        sees="positions",
        addons=[Map(FENCE[[(k, k + 1) for k in range(5)]])],
    )


def checks(record):
    flock, pairs = record.pose[-1, 0, 1:], record.contacts[["a", "b"]]
    yield Prediction("sheep in the pen", len(flock), (flock > GATE).sum(), 0)
    yield Prediction("touches of the dog", 0, sum(a == 0 < b for a, b in pairs), 0)
