"""Hide and seek: the hider loses when it is seen; a pillar is between them, and the seeker is big.

Question: how much quicker must a seeker be to see who hides behind a pillar? Try your own laws:
mars2d run hide_and_seek --set hider=my_law.py --set mu=1.1 --seed 3
Setting: distributed, sensors only: both know their own pose. The seeker sees who is in its line of
sight; the hider hears the seeker, through the pillar. The hider goes 0.5 m/s, the seeker mu times
that, drawn about the limit of the 60 s if it is 0. An evader is seen when the pillar does not cut
the line between the middles of both.
Source: our own geometry; Bhattacharya and Hutchinson, IJRR 30(14), 2011, have the game at corners.
Prediction: at D and h from the pillar's middle they see each other if the angle between them is
less than acos(R / D) + acos(R / h). It falls by mu v / D - v / h a second: never if mu < D / h.
"""

from math import acos, atan2, cos, pi, sin
from typing import Annotated

import numpy as np
import theory

from mars2d import Animation, Holonomic, Range, Robot, Scenario, load_law
from mars2d.addons import Game, Map, Theory
from mars2d.sensors import Pose, RangeBearing

SPEED, VIOLET = 0.5, "#7b3294"  # m/s, of the hider


def circle(angle, radius):
    return radius * cos(angle), radius * sin(angle)


def scenario(
    mu: float = 0.0,
    seeker: str = "seekers/circle.py",
    hider: str = "hiders/opposite.py",
    pillar: Annotated[float, Range(0.5, 3)] = 1.5,  # m, its radius
    seed: int = 0,
):
    def shadow(scene, frame):
        x, y = frame.pose[:2, 0]
        half = acos(min(1, pillar / np.hypot(x, y)))
        for side in (-half, half):
            touch = np.array(circle(atan2(y, x) + side, pillar))
            scene.line([touch, touch + 2 * (touch - (x, y))], stroke=VIOLET, width=1.5)

    near, far = pillar + 0.25, pillar + 0.55  # m, of the circles on which they run
    rng = np.random.default_rng(seed)
    apart = rng.uniform(2.3, 3.1)
    gain = apart - acos(pillar / far) - acos(pillar / near)  # rad, that red has to make up
    mu = mu or far * (gain / 60 / SPEED + 1 / near) * rng.uniform(0.96, 1.04)
    eyes, ears = (RangeBearing(range=20, through_walls=hears) for hears in (False, True))
    slow, quick = (Holonomic(max_linear_speed=speed) for speed in (SPEED, mu * SPEED))
    red = Robot(name="red", diameter=1.0, drive=quick, sees="sensors", sensors=[Pose(), eyes])
    blue = red.replace(name="blue", diameter=0.4, drive=slow, sensors=[Pose(), ears])
    red, blue = red.replace(controller=load_law(seeker)), blue.replace(controller=load_law(hider))
    game = Game({"seeker": ["red"], "hider": ["blue"]}, capture="sight")
    return Scenario(
        title="Hide and seek",
        robots=[red.at(far, 0, 0), blue.at(*circle(apart, near))],
        on_exit="wall",
        stop_time=60.0,
        addons=[Map([[circle(k * pi / 24, pillar) for k in range(48)]]), game, Theory(shadow)],
        animation=Animation(base_colors=("red", "blue"), playback_speed=4),
    )


checks = theory.checks


def miss(record):
    return -np.subtract(*theory.times(record))
