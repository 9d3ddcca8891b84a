"""Two robots wander among obstacles (MARS, Algorithm 2, Figure 2).

Setting: distributed, sensors only. Source: Casini & Garulli (2016), section 4.
"""

import numpy as np

from mars2d import Animation, Robot, Scenario
from mars2d.addons import Map
from mars2d.sensors import Proximity


def wander(robot):
    if robot.sense.proximity:
        return -0.2, 0.0  # something is close: back off,
    if robot.command[0] < 0:
        return 0.0, robot.rng.uniform(np.pi / 2, 3 * np.pi / 2)  # then turn,
    return 0.2, 0.0  # else straight on


walker = Robot(diameter=0.18, sensors=[Proximity(range=0.3)], controller=wander, sees="sensors")

scenario = Scenario(
    title="Random movements",
    robots=[walker.at(1, 3, 0), walker.at(9, 7, np.pi)],
    workspace=[(0, 0), (0, 10), (10, 10), (10, 0)],
    sampling_time=1.0,
    stop_time=1000.0,
    addons=[
        Map(
            [
                [(5, 2), (4, 3), (6, 4), (5, 3)],
                [(4, 5), (3, 7), (2, 8), (1, 6), (2, 5)],
                [(6, 6), (7, 7), (8, 6)],
                [(0, 0), (0, 10)],
                [(0, 10), (10, 10)],
                [(10, 10), (10, 0)],
                [(10, 0), (0, 0)],
            ]
        )
    ],
    animation=Animation(playback_speed=10),
)
