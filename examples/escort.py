"""Escort: a guard keeps its body between a hunter and its prey, which only bodies can.

Question: how slow may the guard be? Play with laws of your own, for either of the two:
mars2d run escort --set hunter=my_law.py --set mu=0.6 --seed 3
Setting: distributed, partial information: each knows its own pose and where the others are. The
hunter goes 0.5 m/s, the guard mu times that; the prey stands. A distance of 0.41 m from hunter to
prey counts, which is a touch; bodies have a diameter of 0.4 m. The hunter has 40 s.
Law of the guard: stay at the distance b from the prey, in the direction of the hunter.
Source: our own geometry, by the angular speeds of those on two circles.
Prediction: the hunter is kept out to D = b + 0.4 m, from where it turns round the prey by at most
v / D. The guard turns by mu v / b, and is always between if mu > b / D = 0.51; without bodies never.
"""

import numpy as np

from mars2d import Animation, Holonomic, Prediction, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

SPEED, SIZE, NEAR, FAR, VIOLET = 0.5, 0.4, 0.42, 3.0, "#7b3294"  # m/s, of the hunter; m
CAPTURE = 0.41  # m
RATIO = NEAR / (NEAR + SIZE)


def stand(robot):
    return 0.0, 0.0


def scenario(
    mu: float = 0.6,
    hunter: str = "escort_hunters/round.py",
    escort: str = "escorts/between.py",
    seed: int = 0,
):
    def rings(scene, frame):
        x, y = frame.pose[:2, 2]
        scene.circle((x, y), NEAR, stroke=VIOLET, width=1.5)
        scene.circle((x, y), NEAR + SIZE, stroke=VIOLET, width=1.5)

    robot = Robot(diameter=SIZE, sees="positions", friction=0.1)
    slow, quick = (Holonomic(max_linear_speed=speed) for speed in (mu * SPEED, SPEED))
    angle, other = np.random.default_rng(seed).uniform(0, 2 * np.pi, 2)
    way, aside = ([np.cos(a), np.sin(a)] for a in (angle, other))
    red = robot.replace(name="hunter", drive=quick, controller=load_law(hunter), color="red")
    blue = robot.replace(name="guard", drive=slow, controller=load_law(escort), color="blue")
    green = robot.replace(name="prey", drive=slow, controller=stand, color="green")
    return Scenario(
        title="Escort",
        robots=[red.at(*np.multiply(FAR, way)), blue.at(*np.multiply(NEAR, aside)), green.at(0, 0)],
        workspace=[(-4, -4), (4, -4), (4, 4), (-4, 4)],
        on_exit="wall",
        sampling_time=0.05,
        stop_time=40.0,
        addons=[
            Game({"hunter": ["hunter"], "escort": ["guard"]}, hunted=["prey"], capture=CAPTURE),
            Theory(rings),
        ],
        animation=Animation(playback_speed=2),
    )


def free(record):
    """Whether the prey is free in the end: by the formula, and in the run."""
    hunter, guard, _ = (robot.drive.max_linear_speed for robot in record.scenario.robots)
    apart = np.hypot(*(record.pose[-1, :2, 0] - record.pose[-1, :2, 2]))
    return int(guard / hunter > RATIO), int(apart > CAPTURE)


def survives(record):
    return free(record)[1]


def checks(record):
    yield Prediction("the prey is free in the end", *free(record), 0)
