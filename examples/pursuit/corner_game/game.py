"""Corner pursuit as a game: a pursuer that may be slower than the evader, and a law for each.

Question: who catches whom, up to which ratio mu of the speeds? Play with laws of your own:
mars2d run corner_game --set pursuer=my_law.py --set mu=0.9 --seed 3
Setting: distributed, partial information: each knows its own pose and where the other is, and asks
for a velocity (vx, vy), which its drive shortens to its speed. A capture is a contact. In 200 s the
evader can go 100 m, as far as that of pursuit_corners. Source: Casini and Garulli, 2016, 5.1.
Measured: captures in 10 matches, seeds 0 to 9, at mu = 0.8, 0.85, 0.9, 0.95, 1:
            away            corners         round
straight    10 10 10 10 10  0 0 0 10 10     0 0 0 0 10
ahead       10 10 10 10 10  5 7 10 10 10    0 2 3 3 10
inside      10 10 10 10 10  0 10 10 10 10   0 0 0 10 10
"""

from typing import Annotated

import numpy as np

from mars2d import Animation, Holonomic, Range, Robot, Scenario, load_law
from mars2d.addons import Game

SPEED, APART = 0.5, 4.0  # m/s, of the evader; m, between the starts at least


def starts(seed):
    rng = np.random.default_rng(seed)
    while True:
        red, blue = rng.uniform(-4, 4, (2, 2))
        if np.hypot(*(red - blue)) > APART:
            return red, blue


def scenario(
    mu: Annotated[float, Range(0.3, 1.5)] = 0.8,
    pursuer: str = "pursuers/ahead.py",
    evader: str = "evaders/corners.py",
    seed: int = 0,
):
    robot, (red, blue) = Robot(diameter=0.55, sees="positions"), starts(seed)
    slow, quick = (Holonomic(max_linear_speed=speed) for speed in (mu * SPEED, SPEED))
    return Scenario(
        title="Corner pursuit",
        robots=[
            robot.replace(name="red", drive=slow, controller=load_law(pursuer)).at(*red),
            robot.replace(name="blue", drive=quick, controller=load_law(evader)).at(*blue),
        ],
        on_exit="wall",
        stop_time=200.0,
        addons=[Game({"pursuer": ["red"], "evader": ["blue"]})],
        animation=Animation(base_colors=("red", "blue"), playback_speed=10),
    )
