"""Round a pillar: the oldest way to stay free is to run round something.

Question: which pursuer catches an evader that runs round a pillar, and when? Try your own laws:
mars2d run round_a_pillar --set evader=my_law.py --set mu=1 --seed 3
Setting: distributed, partial information: each knows its own pose and where the other is, and where
the pillar stands. The evader goes 0.5 m/s, the pursuer mu times that. A distance of 0.7 m counts.
Law: the evader runs along a circle of the radius h to keep opposite; the pursuer comes after it.
Source: obstacle tag: Isaacs, Differential Games, Wiley, 1965, problem 6.10.1. The formula is ours.
Prediction: both on the circle, the angle a between them falls by (mu - 1) v / h a second. Equals run
for ever, and a chord of the capture distance l ends it: t = (a h - 2 h asin(l / 2 h)) / (mu - 1) v.
"""

from math import acos, asin, atan2, pi

import numpy as np

from mars2d import Animation, Holonomic, Prediction, Robot, Scenario, load_law
from mars2d.addons import Game, Map, Theory
from mars2d.geometry import wrap

SPEED, PILLAR, RADIUS, CAPTURE, VIOLET = 0.5, 1.5, 1.75, 0.7, "#7b3294"  # m/s, of the evader; m


def circle(angles, radius):
    return radius * np.array([np.cos(angles), np.sin(angles)])


def shortest(start, end):
    """The shortest way between two places that keeps out of the circle, (2, k)."""
    angle, turn = atan2(start[1], start[0]), float(wrap(atan2(end[1], end[0]) - atan2(*start[::-1])))
    out = [acos(min(1, RADIUS / np.hypot(*place))) for place in (start, end)]
    if abs(turn) <= sum(out):
        return np.transpose([start, end])
    arc = angle + np.sign(turn) * np.linspace(out[0], abs(turn) - out[1], 50)
    return np.hstack([np.transpose([start]), circle(arc, RADIUS), np.transpose([end])])


def scenario(
    mu: float = 1.25,
    pursuer: str = "pillar_pursuers/shortest.py",
    evader: str = "pillar_evaders/opposite.py",
    seed: int = 0,
):
    def way(scene, frame):
        scene.line(shortest(*frame.pose[:2].T).T, stroke=VIOLET, width=2)

    robot, apart = Robot(diameter=0.4, sees="positions"), np.random.default_rng(seed).uniform(2, 3.1)
    slow, quick = (Holonomic(max_linear_speed=speed) for speed in (SPEED, mu * SPEED))
    red = robot.replace(name="red", drive=quick, controller=load_law(pursuer))
    blue = robot.replace(name="blue", drive=slow, controller=load_law(evader))
    pillar = Map([circle(np.arange(48) * pi / 24, PILLAR).T.tolist()])
    return Scenario(
        title="Round a pillar",
        robots=[red.at(RADIUS, 0, 0), blue.at(*circle(apart, RADIUS))],
        workspace=[(-4, -4), (4, -4), (4, 4), (-4, 4)],
        on_exit="wall",
        stop_time=60.0,
        addons=[pillar, Game({"pursuer": ["red"], "evader": ["blue"]}, capture=CAPTURE), Theory(way)],
        animation=Animation(base_colors=("red", "blue"), playback_speed=4),
    )


def times(record):
    """When the evader is caught by the formula, at most the stop time, and in the run [s]."""
    red, blue = (robot.drive.max_linear_speed for robot in record.scenario.robots)
    (x, y), end = record.pose[0, :2, 1], record.scenario.stop_time
    way = RADIUS * (atan2(y, x) - 2 * asin(CAPTURE / 2 / RADIUS))
    return min(end, way / (red - blue)) if red > blue else end, record.time[-1]


def miss(record):
    predicted, measured = times(record)
    return measured - predicted


def checks(record):
    yield Prediction("the evader is free for", *times(record), 0.5, "s")
