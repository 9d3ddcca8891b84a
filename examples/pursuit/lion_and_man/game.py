"""Lion and man: in a round arena, at equal speeds, can the lion be sure of his meal?

Setting: distributed, partial information: each knows its own pose and where the other is, and asks
for a velocity. The lion starts in the middle. A touch is a meal: both are discs, `reach` across.
The lion wins by a meal within the par, drawn from 0.94 to 1.14 of the time below.
Source: R. Rado's problem, with A. S. Besicovitch's man, in J. E. Littlewood, A Mathematician's
Miscellany, 1953; L. Alonso, A. S. Goldstein and E. M. Reingold, Lion and Man: Upper and Lower
Bounds, ORSA Journal on Computing 4, 1992: comes the lion as near as c, it takes a time of the order
of (R / v) log(R / c); as a point, it never catches a point that runs as Besicovitch says.
Prediction: a man runs round the middle at the distance R, and the lion keeps on his radius. Then it
is R sin(v t / R) from the middle, on a circle half as large, and c behind him after the time
(R / v) asin(1 - c / R).
"""

from math import cos, pi, sin

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

RADIUS, SPEED = 4.0, 0.5  # m, where the man's middle can be; m/s
AROUND = np.linspace(0, 2 * pi, 120, endpoint=False)


def scenario(
    lion: str = "lions/radius.py",
    man: str = "men/circle.py",
    start: float = 0.9,  # where he is, in shares of the radius
    reach: float = 0.2,  # m
    accel: float = 0.0,  # m/s^2, what feet hold, 0: any
    seed: int = 0,
):
    def half(scene, frame):
        x, y = frame.scenario.initial_pose[:2, 1]
        for middle, part in (((-y / 2, x / 2), 0.5), ((0, 0), 1)):
            scene.circle(middle, part * np.hypot(x, y), stroke="#7b3294", width=2)

    rng, hold = np.random.default_rng(seed), {"force_limited": accel > 0}
    way, share, far = rng.uniform(0, 2 * pi), rng.uniform(0.94, 1.14), start * RADIUS
    par = round(share * theory.meal(far, 0, reach, SPEED), 1)
    game = Game({"lion": ["lion"], "man": ["man"]}, par=par, to_the_end=True)
    feet = Holonomic(max_linear_speed=SPEED, max_force=accel or 5.0, **hold)
    red = Robot(
        name="lion", sees="positions", diameter=reach, drive=feet, controller=load_law(lion)
    )
    blue = red.replace(name="man", controller=load_law(man))
    edge = (RADIUS + reach / 2) / cos(pi / len(AROUND))
    return Scenario(
        title="Lion and man",
        robots=[red.at(0, 0), blue.at(far * cos(way), far * sin(way))],
        workspace=edge * np.transpose([np.cos(AROUND), np.sin(AROUND)]), on_exit="wall",
        sampling_time=0.05, stop_time=200.0,
        addons=[game, Theory(half)],
        animation=Animation(base_colors=("red", "blue"), playback_speed=5),
    )  # fmt: skip


checks = theory.checks
