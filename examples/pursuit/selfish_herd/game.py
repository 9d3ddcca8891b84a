"""The selfish herd: an animal is safer in a larger flock, and with a smaller domain of danger.

Question: what does an animal gain from others beside it? Play with laws of your own:
mars2d run selfish_herd --set flock=my_law.py --set number=24 --seed 3
Setting: distributed, partial information: each knows its own pose and where all others are; all of
the flock have the same law, but the first one, if `other` is a law of its own. A predator appears
anywhere in a field of 8 m by 8 m, but not within 0.6 m of one, and goes 0.5 m/s, the flock
0.3 m/s. A distance of 0.4 m is a capture. It needs `wanted` of them within 30 s.
Law of the predator: run at whoever is nearest. Of the flock: run straight away from it.
Source: Hamilton, Geometry for the selfish herd, J. theor. Biol. 31, 295-311, 1971; the straight
chase: Apollonius. Foster and Treherne, Nature 293, 466-467, 1981, have counted it at sea.
Prediction: the first victim is the one in whose domain of danger, its Voronoi cell, the predator
appears: of N, each with 1 / N on average. It is free for (d - l) / (v - u).
"""

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Theory
from mars2d.geometry import Tessellation, rectangle

FAST, SLOW, CAPTURE, NEAR, VIOLET = 0.5, 0.3, 0.4, 0.6, "#7b3294"  # m/s, m/s, m, m
WOLF, FLOCK = "predators/nearest.py", "flocks/away.py"


def scenario(number=12, wanted=3, predator=WOLF, flock=FLOCK, other="", seed: int = 0):
    def domains(scene, frame):
        wolf, sheep = np.split(frame.scenario.initial_pose[:2], [1], axis=1)
        victim = np.hypot(*(sheep - wolf)).argmin()
        for k, cell in enumerate(Tessellation(sheep, rectangle(-5, 5, -5, 5)).cells):
            fill = VIOLET + "30" if k == victim else None
            scene.polygon(cell.exterior.coords, stroke=VIOLET, width=1, fill=fill)

    rng, robot = np.random.default_rng(seed), Robot(diameter=0.3, sees="positions")
    grid = [(k // 7 - 3, k % 7 - 3) for k in range(49)]
    at = 0.9 * rng.permutation(grid)[:number] + rng.uniform(-0.2, 0.2, (number, 2))
    places = rng.uniform(-4, 4, (100, 2))
    apart = np.hypot(*(places[:, :, None] - at.T).swapaxes(0, 1))  # (100, number)
    start = places[(apart.min(axis=1) > NEAR).argmax()]
    quick, slow = (Holonomic(max_linear_speed=speed) for speed in (FAST, SLOW))
    red = robot.replace(name="wolf", drive=quick, color="red", controller=load_law(predator))
    gray = robot.replace(drive=slow, color="gray", controller=load_law(flock))
    team = [gray.replace(name=f"sheep {k + 1}").at(*at[k]) for k in range(number)]
    team[0] = team[0].replace(controller=load_law(other or flock))
    roles = {"predator": ["wolf"], "flock": range(1, number + 1)}
    game = Game(roles, capture=CAPTURE, wanted=min(wanted, number))
    return Scenario(
        title="The selfish herd",
        robots=[red.at(*start), *team],
        workspace=None,
        stop_time=30.0,
        addons=[game, Theory(domains)],
        animation=Animation(playback_speed=2),
    )


checks, caught = theory.checks, theory.caught
