"""Push a box: it moves when the drive is stronger than the floor's friction.

Question: a robot of mass M drives against a box of mass m, with at most the force F and at the
speed v. Which boxes can it push, how soon do they go at full speed, how hard does it press?
Prediction: the floor holds a box with up to mu m g (Coulomb, 1785). If F is larger, it gathers
speed at a = (F - mu m g) / (M + m) until it goes at v (Newton's second law), and from then on the
robot presses with mu m g. If F is smaller, the box stays, and the robot presses with F.
Measured: each box's speed after 1 s and its path, and the contact's force at the end. The
friction of the second box is 1.9 % below F, that of the third 2 % above.
"""

from typing import Annotated

import numpy as np

from mars2d import Animation, Prediction, Range, Robot, Scenario, Unicycle
from mars2d.bodies import Box
from mars2d.core.materials import GRAVITY

SPEED = 0.2  # m/s
MASSES, LANES = (0.5, 1.0, 1.04, 2.0), (1.5, 0.5, -0.5, -1.5)  # kg, m
N = Range(0.5, 20, unit="N")


def scenario(mu: Annotated[float, Range(0, 1.5)] = 0.5, force: Annotated[float, N] = 5.0):
    pusher = Robot(diameter=0.3, drive=Unicycle(max_force=force), color="#0072b2")
    box = Box(length=0.4, width=0.4, ground_friction=mu, color="#e69f00")
    return Scenario(
        title="Push a box",
        robots=[pusher.at(-0.3499, y) for y in LANES],  # they touch the boxes
        props=[
            box.at(0, y).replace(name=f"box of {mass:g} kg", mass=mass)
            for mass, y in zip(MASSES, LANES, strict=True)
        ],
        workspace=[(-1, -2), (-1, 2), (3, 2), (3, -2)],
        stop_time=12.0,
        animation=Animation(forces=True, names=True),
    )


def control(world):
    return np.outer([SPEED, 0.0], np.ones(len(world.robots)))


def checks(record):
    if any(robot.drive.no_load_speed for robot in record.scenario.robots):
        yield Prediction.silent("way and force", "with a no_load_speed the force falls with speed")
        return
    time, dt = record.time[-1], record.scenario.sampling_time
    last = record.frame(-1).contacts
    for i, box in enumerate(record.scenario.props):
        robot, x = record.scenario.robots[i], record.prop_pose[:, 0, i]
        force, friction = robot.push, box.ground_friction * box.mass * GRAVITY
        a = max(force - friction, 0.0) / (robot.mass + box.mass)
        start = min(SPEED / a, time) if a else time  # for so long it gathers speed, if it does
        gain, path = min(a, SPEED), a * start * (time - start / 2)
        press = friction if start < time else force - robot.mass * a
        speed = np.interp(1.0, record.time, np.gradient(x, dt))
        pressed = last[last["a"] == i]["normal_impulse"].sum() / dt
        yield Prediction(f"{box.name}: speed after 1 s", gain, speed, 0.02 * gain + 1e-6, "m/s")
        yield Prediction(f"{box.name}: path", path, x[-1] - x[0], 0.005 * path + 1e-4, "m")
        yield Prediction(f"{box.name}: force", press, pressed, 0.01, "N")
