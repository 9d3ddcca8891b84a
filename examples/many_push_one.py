"""Many push one: the forces of several robots add up.

Question: one load, too heavy for one robot. How many must push?
Prediction: the floor holds the load of mass m with up to mu m g (Coulomb, 1785). Forces add up, so
k robots of mass M and force F move it if k F > mu m g. Then it gathers speed at
a = (k F - mu m g) / (k M + m) (Newton's second law) until it goes at the speed v of the robots.
From then on they press with mu m g together; those that can't move it press with k F.
Measured: each load's path and last speed, and the sum of the contacts' forces, for 1 to 4 robots.
"""

import numpy as np

from mars2d import Animation, Robot, Scenario, Unicycle
from mars2d.motion import GRAVITY
from mars2d.prediction import Prediction
from mars2d.props import Box

SPEED = 0.2  # m/s
TEAMS, LANES = (1, 2, 3, 4), (2.4, 0.8, -0.8, -2.4)  # robots, m


def scenario(mu: float = 0.2, force: float = 7.0):
    load = Box(length=0.4, width=1.2, mass=10, ground_friction=mu, color="#e69f00")
    pusher = Robot(diameter=0.2, mass=2, drive=Unicycle(max_force=force))
    return Scenario(
        title="Many push one",
        robots=[
            pusher.replace(pose=(-0.3 + 1e-6, y + 0.3 * (i - (team - 1) / 2), 0), color=color)
            for team, y, color in zip(TEAMS, LANES, COLORS, strict=True)
            for i in range(team)
        ],
        props=[load.at(0, y) for y in LANES],
        workspace=[(-1.5, -3.4), (-1.5, 3.4), (3.5, 3.4), (3.5, -3.4)],
        sampling_time=0.05,
        stop_time=12.0,
        animation=Animation(),
    )


COLORS = ("#0072b2", "#009e73", "#cc79a7", "#d55e00")


def control(world):
    return np.array([[SPEED] * 10, [0.0] * 10])


def checks(record):
    time, dt = record.scenario.stop_time, record.scenario.sampling_time
    robot = record.scenario.robots[0]
    for i, (team, load) in enumerate(zip(TEAMS, record.scenario.props)):
        force, friction = team * robot.drive.max_force, load.ground_friction * load.mass * GRAVITY
        a = max(force - friction, 0) / (team * robot.mass + load.mass)
        start = min(SPEED / a, time) if a > 0 else time  # how long it gathers speed
        path = a * start**2 / 2 + a * start * (time - start)
        x = record.prop_pose[:, 0, i]
        touch = record.contacts[record.contacts["b"] == 10 + i]
        press = touch["normal_impulse"][-team:].sum() / dt
        yield Prediction(f"{team} robots: path", path, x[-1] - x[0], 0.0025, "m")
        yield Prediction(f"{team} robots: speed", a * start, (x[-1] - x[-2]) / dt, 1e-5, "m/s")
        yield Prediction(f"{team} robots: force", min(force, friction), press, 1e-4, "N")
