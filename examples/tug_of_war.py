"""Tug of war: a rope joins two teams, and the stronger one wins.

Question: two robots pull against a single strong one. Who wins, and when? Which box can one tow?
Prediction: on a taut rope all gather speed together, at a = (sum of forces) / (sum of masses)
(Newton's second law); a team has drawn the middle over its line, d away, after sqrt(2 d / |a|). The
floor holds a box of mass m with up to mu m g (Coulomb, 1785): a robot of mass M and force F tows it
only if F > mu m g, and then with a = (F - mu m g) / (M + m).
Measured: the middle's way and time to the line, the ways of the boxes; of these the floor holds one
with 2 % less than F and one with 2 % more.
"""

from math import pi, sqrt

import numpy as np

from mars2d import Addon, Animation, Robot, Scenario, Unicycle
from mars2d.joints import Rope
from mars2d.floor import GRAVITY
from mars2d.prediction import Prediction
from mars2d.props import Box

LINE = 1.0  # m, from the middle to a team's line
RED, BLUE, GREEN = "#d55e00", "#0072b2", "#009e73"


class Umpire(Addon):
    """Ends the game when the rope's middle is drawn over a line."""

    def on_step(self, world):
        middle = world.pose[0, 1:3].mean()
        if abs(middle) > LINE:
            world.stop(f"{'red' if middle < 0 else 'blue'} wins after {world.time:g} s")

    def on_draw(self, world, scene):
        for x in (-LINE, 0.0, LINE):
            scene.line([(x, 0.7), (x, 1.3)], stroke="#888888", width=2)


def scenario(red: float = 3.0, blue: float = 5.85, tow: float = 5.0):
    def robot(x, y, heading, force, color, name):
        drive = Unicycle(max_force=force, max_linear_speed=2)
        return Robot(pose=(x, y, heading), drive=drive, color=color, name=name)

    box = Box(mass=1, color="#e69f00")
    boxes = [(0, 0.98, "light box"), (-1, 1.02, "heavy box")]
    return Scenario(
        title="Tug of war",
        robots=[
            *[robot(x, 1, pi, red, RED, f"red {x:g}") for x in (-1.0, -0.5)],
            robot(0.5, 1, 0, blue, BLUE, "blue"),
            *[robot(-0.5, y, 0, tow, GREEN, f"tug of {name}") for y, _, name in boxes],
        ],
        props=[
            box.at(-1.5, y).replace(name=name, ground_friction=share * tow / (box.mass * GRAVITY))
            for y, share, name in boxes
        ],
        joints=[Rope(a="red -1", b="red -0.5"), Rope(a="red -0.5", b="blue")]
        + [Rope(a=f"tug of {name}", b=name) for *_, name in boxes],
        workspace=[(-3, -1.5), (-3, 1.5), (3, 1.5), (3, -1.5)],
        sampling_time=0.02,
        stop_time=20.0,
        addons=[Umpire()],
        animation=Animation(),
    )


def control(world):
    return np.outer([2.0, 0.0], np.ones(len(world.robots)))


def checks(record):
    end = record.time[-1]
    red, red2, blue, *tugs = record.scenario.robots
    force = blue.drive.max_force - red.drive.max_force - red2.drive.max_force
    a = force / (red.mass + red2.mass + blue.mass)
    yield Prediction.within("time", sqrt(2 * LINE / abs(a)), end, 1, "s")
    middle = record.pose[-1, 0, 1:3].mean()
    yield Prediction.within("middle", a*end**2/2, middle, 1, "m")
    for k, (tug, box) in enumerate(zip(tugs, record.scenario.props, strict=True)):
        f = tug.drive.max_force - box.ground_friction * box.mass * GRAVITY
        a = max(f, 0) / (tug.mass + box.mass)
        yield Prediction(f"{box.name} towed", a * end**2 / 2, record.prop_pose[-1, 0, k] - box.pose[0], 0.01, "m")
