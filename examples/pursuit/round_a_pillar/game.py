"""Round a pillar: the oldest way to stay free is to run around something.

Question: which pursuer catches an evader that runs round a pillar, and when? Try your own laws:
mars2d run round_a_pillar --set evader=my_law.py --set mu=1 --seed 3
Setting: distributed, partial information: each knows its own pose and where the other is. The
evader goes 0.5 m/s, the pursuer mu times that, drawn about the limit of the 60 s if it is 0.
Source: obstacle tag: Isaacs, Differential Games, 1965, problem 6.10.1. The formula is ours.
Prediction: on a circle of radius h the angle a between them falls by (mu - 1) v / h a second, to
the chord l of a capture: t = (a h - 2 h asin(l / 2 h)) / ((mu - 1) v). Equals run for ever.
"""

from math import acos, asin, atan2, cos, pi, sin
from typing import Annotated

import numpy as np
import theory

from mars2d import Animation, Holonomic, Range, Robot, Scenario, load_law
from mars2d.addons import Game, Map, Theory
from mars2d.geometry import wrap

SPEED, CAPTURE, VIOLET = 0.5, 0.7, "#7b3294"  # m/s, of the evader; m


def circle(angle, radius):
    return radius * cos(angle), radius * sin(angle)


def shortest(start, end, radius):
    """The shortest way between two places that keeps out of the circle, as points."""
    angle, last = (atan2(y, x) for x, y in (start, end))
    out = [acos(min(1, radius / np.hypot(*place))) for place in (start, end)]
    side, rest = np.sign(turn := wrap(last - angle)), abs(turn) - sum(out)  # between tangents
    arc = [angle + side * (out[0] + part * rest) for part in np.linspace(0, 1, 50)]
    return [start, *(circle(each, radius) for each in arc * int(rest > 0)), end]


def scenario(
    mu: float = 0.0,
    pursuer: str = "pursuers/shortest.py",
    evader: str = "evaders/opposite.py",
    pillar: Annotated[float, Range(0.5, 3)] = 1.5,  # m, its radius
    seed: int = 0,
):
    def way(scene, frame):
        scene.line(shortest(*frame.pose[:2].T, h), stroke=VIOLET, width=2)

    robot, rng = Robot(diameter=0.4, sees="positions"), np.random.default_rng(seed)
    angle, h = rng.uniform(2, 3.1), pillar + 0.25
    gain = angle * h - 2 * h * asin(CAPTURE / 2 / h)  # m, that red has to make up
    mu = mu or 1 + gain / 60 / SPEED * rng.uniform(0.85, 1.15)
    slow, quick = (Holonomic(max_linear_speed=speed) for speed in (SPEED, mu * SPEED))
    red = robot.replace(name="red", drive=quick, controller=load_law(pursuer))
    blue = robot.replace(name="blue", drive=slow, controller=load_law(evader))
    game = Game({"pursuer": ["red"], "evader": ["blue"]}, capture=CAPTURE)
    return Scenario(
        title="Round a pillar",
        robots=[red.at(h, 0), blue.at(*circle(angle, h))],
        on_exit="wall",
        stop_time=60.0,
        addons=[Map([[circle(k * pi / 24, pillar) for k in range(48)]]), game, Theory(way)],
        animation=Animation(base_colors=("red", "blue"), playback_speed=4),
    )


checks = theory.checks


def miss(record):
    return -np.subtract(*theory.times(record))
