"""Two robots wander among obstacles (MARS, Algorithm 2, Figure 2).

Setting: distributed with sensors only. Source: Casini & Garulli (2016), section 4.
Prediction: a turn is even in (90, 270) degrees: its mean is 180, its standard deviation ("spread")
180 / sqrt(12), unless the wheels are too slow for some of them. They go 0.2 m in each step in which
they don't turn, or less if they touch something.
Measured: all turns of both, to four standard errors; how far both went.
"""

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario
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


def checks(record):
    step, drive = record.scenario.sampling_time, record.scenario.robots[0].drive
    v, omega = record.command[:-1].swapaxes(0, 1) * step  # (steps, n), m and rad
    fastest = np.degrees(drive.max_linear_speed / drive.wheel_semiaxis)
    wanted = np.minimum(np.linspace(90, 270, 100_001), fastest) * step
    turns, mean, spread = np.degrees(omega[v == 0]), wanted.mean(), wanted.std()
    if len(turns):
        fourth = ((wanted - mean) ** 4).mean() / max(spread, 1e-6) ** 4  # 9 / 5 if none is cut
        sure = 4 * max(spread, 1e-6) / np.sqrt(len(turns))
        of_spread = sure * np.sqrt(max(fourth - 1, 0.2) / 4)
        yield Prediction("turn, mean", mean, turns.mean(), sure, "degrees")
        yield Prediction("turn, spread", spread, turns.std(), of_spread, "degrees")
    path = np.hypot(*np.diff(record.pose[:, :2], axis=0).transpose(1, 0, 2)).sum()
    way, bound = abs(v).sum(), "at most" if record.collisions else "equal"
    yield Prediction("path of both", way, path, 0.01 * way, "m", bound=bound)
