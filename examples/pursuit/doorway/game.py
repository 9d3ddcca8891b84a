"""The doorway: a guard stands in a door, and an escort and its prey push their way through it.

Question: how strong must a guard be to hold a door against two that push one behind the other?
mars2d run doorway --set escort=my_law.py --set strength=1.8
Setting: distributed, partial information: each knows its own pose and where all others are. Nobody
is caught: the escort has won when the prey is on the green floor within 40 s. The door is 0.6 m
wide and the robots 0.4 m, so that nobody gets past another one in it. Escort and prey push with
4 N each, the guard with `strength` times that, drawn about the limit if it is 0. All are smooth.
Law of the escort: both go to the middle of the door, one behind the other, and push.
Source: our own statics: along a row of bodies that touch, forces add up.
Prediction: a guard in the door stands if it is at least as strong as all who push at it together:
twice as strong as each of two. One that is weaker is pushed out.
"""

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Map, Theory

FORCE, SIZE, DOOR, VIOLET = 4.0, 0.4, 0.6, "#7b3294"  # N, of escort and prey; m
GOAL = [(2, -2), (3, -2), (3, 2), (2, 2)]
WALLS = [[(-0.3, s * DOOR / 2), (0.3, s * DOOR / 2), (0.3, s * 2), (-0.3, s * 2)] for s in (-1, 1)]
GUARD, ESCORT = "guards/block.py", "escorts/train.py"


def scenario(strength: float = 0.0, guard: str = GUARD, escort: str = ESCORT, seed: int = 0):
    def row(scene, frame):
        scene.line(frame.pose[:2].T, stroke=VIOLET, width=2)

    rng = np.random.default_rng(seed)
    strength = strength or 2 * rng.uniform(0.85, 1.15)
    weak, strong = (Holonomic(max_force=force) for force in (FORCE, strength * FORCE))
    robot = Robot(diameter=SIZE, sees="positions", friction=0, drive=weak)
    red = robot.replace(name="guard", drive=strong, color="red", controller=load_law(guard))
    blue = robot.replace(name="escort", color="blue", controller=load_law(escort))
    green = blue.replace(name="prey", color="green")
    roles = {"guard": ["guard"], "escort": ["escort", "prey"]}
    return Scenario(
        title="The doorway",
        robots=[red.at(0, 0), blue.at(-1, 0), green.at(-1.5, 0)],
        workspace=[(-3, -2), (3, -2), (3, 2), (-3, 2)],
        on_exit="wall",
        sampling_time=0.05,
        stop_time=40.0,
        addons=[Map(WALLS), Game(roles, capture=None, goal=GOAL, hunted=["prey"]), Theory(row)],
        animation=Animation(playback_speed=1, forces=True),
    )


checks = theory.checks


def gets_through(record):
    return int(record.scenario.addons[1].outcome(record).winner == "escort")
