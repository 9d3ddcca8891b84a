"""Push a box: it goes when the drive is stronger than the floor's friction.

Question: a robot of mass M drives against a box of mass m, with at most the force F and at the
speed v. Which boxes can it push, how soon are they at full speed, how hard does it press?
Prediction: the floor holds a box with up to mu m g (Coulomb, 1785). With F above that it gathers
speed at a = (F - mu m g) / (M + m) (Newton's second law) until it goes at v; from then on the
robot presses with mu m g. With F below, the box stays where it is, and the robot presses with F.
Measured: each box's path and last speed, and the contact's force. The friction of the second box
is 1.9 % below F, that of the third 2 % above.
"""

import numpy as np

from mars2d import Animation, Robot, Scenario, Unicycle
from mars2d.motion import GRAVITY
from mars2d.prediction import Prediction
from mars2d.props import Box

SPEED = 0.2  # m/s
MASSES, LANES = (0.5, 1.0, 1.04, 2.0), (1.5, 0.5, -0.5, -1.5)  # kg, m


def scenario(mu: float = 0.5, force: float = 5.0):
    box = Box(length=0.4, width=0.4, ground_friction=mu, color="#e69f00")
    pusher = Robot(diameter=0.3, drive=Unicycle(max_force=force), color="#0072b2")
    return Scenario(
        title="Push a box",
        robots=[pusher.at(-0.35 + 1e-6, y) for y in LANES],  # they just touch the boxes
        props=[
            box.at(0, y).replace(name=f"box of {mass:g} kg", mass=mass)
            for mass, y in zip(MASSES, LANES, strict=True)
        ],
        workspace=[(-1, -2), (-1, 2), (3, 2), (3, -2)],
        stop_time=12.0,
        animation=Animation(),
    )


def control(world):
    return np.array([[SPEED] * 4, [0.0] * 4])


def checks(record):
    time, dt = record.scenario.stop_time, record.scenario.sampling_time
    for i, (robot, box) in enumerate(zip(record.scenario.robots, record.scenario.props)):
        force, friction = robot.drive.max_force, box.ground_friction * box.mass * GRAVITY
        a = max(force - friction, 0) / (robot.mass + box.mass)
        start = min(SPEED / a, time) if a > 0 else time  # how long it gathers speed
        path = a * start**2 / 2 + a * start * (time - start)
        x = record.prop_pose[:, 0, i]
        press = record.contacts[record.contacts["a"] == i]["normal_impulse"][-1] / dt
        yield Prediction(f"{box.name}: path", path, x[-1] - x[0], 0.0025, "m")
        yield Prediction(f"{box.name}: speed", a * start, (x[-1] - x[-2]) / dt, 1e-5, "m/s")
        yield Prediction(f"{box.name}: force", min(force, friction), press, 1e-4, "N")
