"""Straight chase: pure pursuit and constant bearing, where and when by closed form.

Question: who is quicker is sure to catch. How much sooner does it, if it aims well?
Setting: distributed, partial information: each knows its own pose and where the other is, and asks
for a velocity, which its drive shortens. A touch is a capture. Crates may stand in the way.
Source: pure pursuit, P. Bouguer, 1732; constant bearing and the circle of Apollonius, R. Isaacs,
Differential Games, 1965. All hold for points that turn at once, and an evader that runs straight.
Prediction: of the pursuer's speed v the evader has the share g. It runs at the angle phi to the
line of sight, which is r long. Pure pursuit takes r (1 + g cos phi) / (v - g^2 v), constant bearing
r / (v sqrt(1 - g^2 sin(phi)^2) - g v cos phi), to a point of the circle of Apollonius; a touch at
the distance d, in r's place, comes so much sooner (for pure pursuit with phi = 0 by then).
"""

from math import cos, dist, hypot, pi, sin, sqrt

import numpy as np

from mars2d import Animation, Holonomic, Prediction, Robot, Scenario, load_law
from mars2d.addons import Game, Theory
from mars2d.bodies import Box

SPEED, VIOLET = 0.5, "#7b3294"  # m/s, of the pursuer


def scenario(
    ratio: float = 0.7,
    pursuer: str = "pursuers/straight.py",
    evader: str = "evaders/across.py",
    crates: bool = False,
    seed: int = 0,
):
    def circle(scene, frame):
        for width, (p, e) in ((1, frame.pose[:2].T), (3, frame.scenario.initial_pose[:2].T)):
            middle = e + (e - p) * ratio**2 / (1 - ratio**2)
            scene.circle(middle, dist(p, e) * ratio / (1 - ratio**2), stroke=VIOLET, width=width)

    rng = np.random.default_rng(seed)
    (r, way), start = rng.uniform((3, 0), (4, 2 * pi)), Robot(sees="positions", diameter=0.3)
    red = start.replace(name="red", drive=Holonomic(), controller=load_law(pursuer))
    slow = Holonomic(max_linear_speed=ratio * SPEED)
    blue = start.replace(name="blue", drive=slow, controller=load_law(evader)).at(0, 0)
    red, grid = red.at(r * cos(way), r * sin(way)), np.mgrid[-4:5, -4:5].reshape(2, -1).T * 1.4
    spots = [at for at in grid + rng.uniform(-0.4, 0.4, grid.shape) for _ in range(crates)]
    clear = [at for at in spots if min(hypot(*at), dist(at, red.pose[:2])) > 0.6]
    return Scenario(
        title="Straight chase", robots=[red, blue],
        props=[Box(mass=0.5, ground_friction=0.2).at(*at) for at in clear],
        workspace=[(-8, -8), (8, -8), (8, 8), (-8, 8)], on_exit="wall", stop_time=60.0,
        addons=[Game({"pursuer": ["red"], "evader": ["blue"]}), Theory(circle)],
        animation=Animation(base_colors=("red", "blue"), playback_speed=4),
    )  # fmt: skip


def checks(record):
    path, caught = record.pose[:-1, :2], record.scenario.addons[0].outcome(record).captures
    step, sight = np.diff(path, axis=0), path[:-1, :, 1] - path[:-1, :, 0]
    r, moved = np.hypot(*sight.T), np.hypot(*step.transpose(1, 0, 2))
    straight = np.hypot(*step[:, :, 1].sum(axis=0)) > 0.999 * moved[:, 1].sum()  # the evader
    if caught and straight and not record.scenario.props:
        g, near = moved[0, 1] / moved[0, 0], record.scenario.robots[0].diameter
        phi = np.arccos(np.clip(sight[0] @ step[0, :, 1] / r[0] / moved[0, 1], -1, 1))
        if ((sight * step[:, :, 0]).sum(axis=1) > 0.99 * r * moved[:, 0]).all():  # pure pursuit
            way = (r[0] * (1 + g * cos(phi)) - near * (1 + g)) / (1 - g**2)
            yield Prediction("capture", way / SPEED, caught[0].time, 0.3, "s")
        elif (sight[1:-1] @ sight[0] > 0.995 * r[0] * r[1:-1]).all():  # constant bearing
            way = (r[0] - near) / (sqrt(1 - (g * sin(phi)) ** 2) - g * cos(phi))
            yield Prediction("capture", way / SPEED, caught[0].time, 0.3, "s")
