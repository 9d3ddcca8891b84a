"""Encirclement: several pursuers surround an evader that is faster than each of them.

Question: how many does it take, and how must they stand?
Setting: distributed, partial information: each knows its own pose and where all others are, and
asks for a velocity. Any touch of the evader is a capture; free after 15 s, it has escaped. The
ratio of the speeds is drawn about the limit for the width if it is 0.
Source: B. N. Pshenichnyi, Simple pursuit by several objects, Cybernetics 12, 1976: at equal speeds
the evader is caught if and only if it is within the pursuers' convex hull. A quicker one, F. L.
Chernous'ko, A problem of evasion from many pursuers, J. Appl. Math. Mech. 40, 1976, escapes any
number of points; so what counts is their width, and whether it runs straight.
Prediction: a pursuer at the share g of its speed meets whoever runs straight on within asin g of
its bearing, whatever the distance. So no straight way is left if no gap is wider than 2 asin g: for
g = 1 that is the hull, for n at even gaps n >= pi / asin g. At the angle b from the bearing, from
asin g to asin g + pi / 2, it comes no nearer than d sin(b - asin g), where d is that at the start.
"""

from math import asin, hypot, pi, sin

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

SPEED, APART, WIDTH = 0.5, 3.0, 0.2  # m/s, of the evader; m, how far all start; m, of each


def scenario(
    n: int = 3,
    ratio: float = 0.0,  # of the speeds, 0: drawn from 0.95 to 1.05 of the limit
    uneven: float = 0.05,  # rad, how far the pursuers may stand off even gaps
    pursuer: str = "pursuers/bearing.py",
    evader: str = "evaders/gap.py",
    accel: float = 0.0,  # m/s^2, what feet hold, 0: any
    seed: int = 0,
):
    def cones(scene, frame):  # the ways on which each pursuer meets the evader
        evader = frame.pose[:2, -1]
        for x, y in (frame.pose[:2, :-1].T - evader).tolist():
            angles = np.arctan2(y, x) + asin(min(ratio, 1)) * np.linspace(-1, 1, 20)
            rim = evader + 0.3 * hypot(x, y) * np.transpose([np.cos(angles), np.sin(angles)])
            scene.polygon([evader, *rim], fill="#7b329430", stroke="#7b3294")

    rng, hold = np.random.default_rng(seed), {"force_limited": accel > 0, "max_force": accel or 5.0}
    ways = rng.uniform(0, 2 * pi) + 2 * pi * np.arange(n) / n + rng.uniform(-uneven, uneven, n)
    ratio = ratio or sin(pi / n - asin(WIDTH / APART)) * rng.uniform(0.95, 1.05)
    slow = Holonomic(max_linear_speed=ratio * SPEED, **hold)
    quick = Holonomic(max_linear_speed=SPEED, **hold)
    red = Robot(sees="positions", diameter=WIDTH, drive=slow, controller=load_law(pursuer))
    names = [f"red{k}" for k in range(n)]
    starts = APART * np.transpose([np.cos(ways), np.sin(ways)])
    hunters = [red.replace(name=names[k]).at(*starts[k]) for k in range(n)]
    blue = red.replace(name="blue", drive=quick, controller=load_law(evader)).at(0, 0)
    return Scenario(
        title="Encirclement", robots=[*hunters, blue],
        workspace=[(-6, -6), (6, -6), (6, 6), (-6, 6)], on_exit="ignore",
        sampling_time=0.05, stop_time=15.0,
        addons=[Game({"pursuers": names, "evader": ["blue"]}), Theory(cones)],
        animation=Animation(base_colors=("red",) * n + ("blue",), playback_speed=3),
    )  # fmt: skip


checks = theory.checks
