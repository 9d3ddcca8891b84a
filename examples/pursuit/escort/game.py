"""Escort: a guard keeps its body between a hunter and its prey: impossible without contact.

Question: how slow may the guard be? Play with laws of your own, for either of the two:
mars2d run escort --set hunter=my_law.py --set mu=0.6 --seed 3
Setting: distributed, partial information: each knows its own pose and where the others are. The
hunter goes 0.5 m/s, the guard mu times that, drawn about the limit if it is 0; the prey stands.
A distance of 0.41 m from hunter to prey counts, which is a touch; bodies have a diameter of 0.4 m.
The hunter has 40 s.
Law of the guard: stay at the distance b from the prey, in the direction of the hunter.
Source: our own geometry, by the angular speeds of those on two circles.
Prediction: the hunter is kept out to D = b + 0.4 m, where it goes round the prey at v / D rad/s at
most. The guard does at mu v / b, so it is always between if mu > b / D = 0.51; with bodies only.
"""

from math import cos, pi, sin

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

SPEED, SIZE, NEAR, FAR, CAPTURE = 0.5, 0.4, 0.42, 3.0, 0.41  # m/s, of the hunter; m
VIOLET = "#7b3294"
HUNTER, ESCORT = "hunters/round.py", "escorts/between.py"


def circle(angle, radius):
    return radius * cos(angle), radius * sin(angle)


def stand(_):
    return 0.0, 0.0


def scenario(mu: float = 0.0, hunter: str = HUNTER, escort: str = ESCORT, seed: int = 0):
    def rings(scene, frame):
        x, y = frame.pose[:2, 2]
        scene.circle((x, y), NEAR, stroke=VIOLET, width=1.5)
        scene.circle((x, y), NEAR + SIZE, stroke=VIOLET, width=1.5)

    robot = Robot(diameter=SIZE, sees="positions", friction=0.1)
    rng = np.random.default_rng(seed)
    angle, other = rng.uniform(0, 2 * pi, 2)
    mu = mu or NEAR / (NEAR + SIZE) * (1.1 - rng.uniform(0, 0.25))
    slow, quick = (Holonomic(max_linear_speed=speed) for speed in (mu * SPEED, SPEED))
    red = robot.replace(name="hunter", drive=quick, controller=load_law(hunter), color="red")
    blue = robot.replace(name="guard", drive=slow, controller=load_law(escort), color="blue")
    green = robot.replace(name="prey", drive=slow, controller=stand, color="green")
    game = Game({"hunter": ["hunter"], "escort": ["guard"]}, hunted=["prey"], capture=CAPTURE)
    return Scenario(
        title="Escort",
        robots=[red.at(*circle(angle, FAR)), blue.at(*circle(other, NEAR)), green.at(0, 0)],
        on_exit="wall",
        sampling_time=0.05,
        stop_time=40.0,
        addons=[game, Theory(rings)],
        animation=Animation(playback_speed=2),
    )


checks = theory.checks


def survives(record):
    return theory.survives(record)
