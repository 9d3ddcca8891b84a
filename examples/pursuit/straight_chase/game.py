"""Straight chase: pure pursuit and constant bearing, where and when by closed form.

Question: who is quicker is sure to catch. How much sooner does it, if it aims well?
Setting: distributed, partial information: each knows its own pose and where the other is, and asks
for a velocity, which its drive shortens. A touch is a capture; the pursuer wins by one within the
par, drawn from 0.4 to 0.75 of the longest chase. Crates may stand in the way.
Source: pure pursuit, P. Bouguer, 1732; constant bearing and the circle of Apollonius, R. Isaacs,
Differential Games, 1965. All hold for points that turn at once, and an evader that runs straight.
Prediction: of the pursuer's speed v the evader has the share g < 1. It runs at the angle phi to the
line of sight, which is r long. Pure pursuit has r sin phi / tan(phi/2)^(1/g) constant, so phi is
known when r is the distance d of a touch; and r (1 + g cos phi) falls by (1 - g^2) v a second.
Constant bearing takes (r - d) / (v sqrt(1 - g^2 sin(phi)^2) - g v cos phi).
"""

from math import cos, dist, hypot, pi, sin

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
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
        way = (e - p) * (1 - start.diameter / dist(p, e)) / (1 - ratio)  # red's, if blue runs away
        for place, share in ((p, 1), (e, ratio)) if abs(e + ratio * way).max() < 8 else ():
            far = min(1, SPEED * frame.time / np.hypot(*way))
            scene.circle(place + share * far * way, start.radius, stroke=VIOLET)

    rng = np.random.default_rng(seed)
    (r, way), start = rng.uniform((3, 0), (4, 2 * pi)), Robot(sees="positions", diameter=0.3)
    red = start.replace(name="red", drive=Holonomic(), controller=load_law(pursuer))
    slow = Holonomic(max_linear_speed=ratio * SPEED)
    blue = start.replace(name="blue", drive=slow, controller=load_law(evader)).at(0, 0)
    red, grid = red.at(r * cos(way), r * sin(way)), np.mgrid[-4:5, -4:5].reshape(2, -1).T * 1.4
    spots = [at for at in grid + rng.uniform(-0.4, 0.4, grid.shape) for _ in range(crates)]
    clear = [at for at in spots if min(hypot(*at), dist(at, red.pose[:2])) > 0.6]
    longest = (r - start.diameter) / SPEED / (1 - ratio) if ratio < 1 else 60.0  # straight away
    game = Game(
        {"pursuer": ["red"], "evader": ["blue"]},
        par=round(longest * rng.uniform(0.4, 0.75), 1), to_the_end=True,
    )  # fmt: skip
    return Scenario(
        title="Straight chase", robots=[red, blue],
        props=[Box(mass=0.5, ground_friction=0.2).at(*at) for at in clear],
        workspace=[(-8, -8), (8, -8), (8, 8), (-8, 8)], on_exit="wall", stop_time=60.0,
        addons=[game, Theory(circle)][: 1 + (ratio < 1)],
        animation=Animation(base_colors=("red", "blue"), playback_speed=4),
    )  # fmt: skip


checks = theory.checks
