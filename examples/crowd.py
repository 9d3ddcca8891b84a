"""A crowd leaves through a door.

Question: fifty robots want through one narrow door at once. How quickly can they come through?
Prediction: discs of diameter d in a doorway of width w < 2 d can't stand side by side, so there lie
at least g = sqrt(d^2 - (w - d)^2) between one and the next along it (Pythagoras). At a speed of at
most v no two leave it within g / v, and no more than v / g in a second (an upper bound: people and
grains come through more slowly, as arches form before the door). Nobody gets lost, and as bodies
are hard, none overlap; the solver is allowed 1 mm.
Measured: the times at which robots leave the doorway, the overlap of all pairs at all times, and
how many are inside and outside at the end.
"""

from math import sqrt

import numpy as np

from mars2d import Animation, Holonomic, Robot, Scenario
from mars2d.addons import Map
from mars2d.prediction import Prediction

DOOR = 0.6  # m, from x = 0 to here goes the doorway


def scenario(n: int = 50, door: float = 0.45, diameter: float = 0.3, speed: float = 0.5):
    walker = Robot(diameter=diameter, friction=0.3, controller=leave, drive=Holonomic(max_linear_speed=speed))
    rows = range(n)
    wall = lambda s: [(0, s * door / 2), (DOOR, s * door / 2), (DOOR, s * 2.5), (0, s * 2.5)]
    return Scenario(
        title="A crowd at a door",
        robots=[walker.at(-0.5 - 0.45 * (k // 10), 0.45 * (k % 10 - 4.5), 0) for k in range(n)],
        workspace=[(-4, -2.5), (-4, 2.5), (4, 2.5), (4, -2.5)],
        on_exit="wall",
        stop_time=60.0,
        addons=[Map([wall(-1), wall(1)])],
        animation=Animation(playback_speed=4),
    )


def leave(robot):
    x, y, _ = robot.pose
    aim = np.array([-x, -y]) if x < 0 else np.array([1.0, 0])
    return 0.5 * aim / np.hypot(*aim) + 0.1 * robot.rng.normal(size=2)


def checks(record):
    x = record.pose[:, 0]
    d = record.scenario.robots[0].diameter
    gap = np.array([[np.inf]])
    deepest = 0
    for row in record.pose:
        dist = np.hypot(*(row[:2, :, None] - row[:2, None]))
        deepest = max(deepest, (d - dist[~np.eye(len(dist), dtype=bool)]).max())
    yield Prediction("overlap", 0, deepest, 1e-3)
    yield Prediction("out", 50, (x[-1] > DOOR).sum(), 0)
