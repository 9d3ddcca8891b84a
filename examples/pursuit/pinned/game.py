"""Pinned: two hunters hold an evader in a corner by their bodies alone, and it pushes to get out.

Question: how strong must an evader be to push its way out, past one hunter and past two?
mars2d run pinned --set evader=my_law.py --set strength=1.1
Setting: distributed, partial information: each knows its own pose and where all others are. Nobody
is caught: the evader has won when its middle is out of the square of 1 m in the corner within 20 s.
A hunter pushes with 4 N, the evader with `strength` times that, drawn about the limit if it is 0.
All are smooth discs of 0.4 m.
Law of the hunters: side by side, each pushes straight at the evader.
Source: our own statics; Coulomb's walls and contacts without friction.
Prediction: a hunter that pushes at the angle a to a wall holds cos a of its force along the wall,
and the evader needs more than the sum along one of the walls. One at 45 degrees holds 1 / sqrt(2)
of its force; two along the walls hold 1; two that touch, at 15 and 75 degrees, sqrt(3 / 2) = 1.22.
"""

from math import cos, radians, sin

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

FORCE, SIZE, NEAR, ROOM, OUT, VIOLET = 4.0, 0.4, 0.401, 2.0, 1.0, "#7b3294"  # N, of a hunter; m
GOAL = [(OUT, 0), (ROOM, 0), (ROOM, ROOM), (0, ROOM), (0, OUT), (OUT, OUT)]
HUNTER, EVADER = "hunters/beside.py", "evaders/along.py"


def scenario(strength: float = 0.0, hunter: str = HUNTER, evader: str = EVADER, seed: int = 0):
    def pushes(scene, frame):
        evader = frame.pose[:2, -1]
        for place in frame.pose[:2, :-1].T:
            scene.line([place, evader], stroke=VIOLET, width=2)

    rng = np.random.default_rng(seed)
    strength = strength or 1.5**0.5 * rng.uniform(0.85, 1.15)
    weak, strong = (Holonomic(max_force=force) for force in (FORCE, strength * FORCE))
    robot = Robot(diameter=SIZE, sees="positions", friction=0)
    red = robot.replace(drive=weak, color="red", controller=load_law(hunter))
    team = [
        red.replace(name=f"red {k}").at(SIZE / 2 + NEAR * cos(angle), SIZE / 2 + NEAR * sin(angle))
        for k, angle in enumerate((radians(15), radians(75)), 1)
    ]
    blue = robot.replace(name="blue", drive=strong, controller=load_law(evader), color="blue")
    roles = {"hunters": ["red 1", "red 2"], "evader": ["blue"]}
    return Scenario(
        title="Pinned",
        robots=[*team, blue.at(SIZE / 2, SIZE / 2)],
        workspace=[(0, 0), (ROOM, 0), (ROOM, ROOM), (0, ROOM)],
        on_exit="wall",
        sampling_time=0.05,
        stop_time=20.0,
        addons=[Game(roles, capture=None, goal=GOAL), Theory(pushes)],
        animation=Animation(playback_speed=1),
    )


checks = theory.checks


def gets_out(record):
    return int(theory.gets_out(record))
