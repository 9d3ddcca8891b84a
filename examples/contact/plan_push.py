"""Plan a push: a robot simulates pushes in advance, and so brings a box to a goal.

Question: can a robot push a box to a goal if nobody tells it how to push?
Law: model predictive control by random shooting. In each control step the robot forks the world
20 times, drives 15 steps in each fork, and takes the first command of the best plan. A plan has
three commands of five steps each. Half of the plans are near the last best one, half are anywhere.
The cost of a plan is the distance of the box from the goal at its end, and a third of the robot's
distance from its place behind the box. Source: J. B. Rawlings, D. Q. Mayne and M. M. Diehl, Model
Predictive Control: Theory, Computation, and Design, Nob Hill, 2017.
Measured: the box reaches the goal from each of 20 starts, after 6 to 20 s, 12 s in the mean.
"""

from math import hypot

import numpy as np

from mars2d import Prediction, RandomStarts, Robot, Scenario, Unicycle
from mars2d.addons import Floor
from mars2d.bodies import Box
from mars2d.core.plane import rectangle

GOAL, NEAR, SIDE = np.array([2.0, 1.0]), 0.1, 0.5  # m
PLANS, COMMANDS, HOLD = 20, 3, 5  # plans a step; commands a plan; steps a command
FASTEST = np.array([0.5, 2.0])[:, None, None]  # m/s, rad/s

scenario = Scenario(
    title="Plan a push",
    robots=[Robot(name="pusher", diameter=0.3, drive=Unicycle(max_force=20), color="#0072b2")],
    props=[Box(name="box", length=SIDE, width=SIDE, mass=1, ground_friction=0.3)],
    workspace=rectangle(-3, 3, -2, 2),
    on_exit="wall",
    random_starts=[
        RandomStarts(["pusher"], area=rectangle(-2.5, -0.5, -1.5, 1.5)),
        RandomStarts(["box"], area=rectangle(0, 1, -1, 1)),
    ],
    stop_time=40.0,
    addons=[Floor(patches=[(rectangle(1.85, 2.15, 0.85, 1.15), "#9fdfbf")])],
)


def cost(world):
    box, robot = world.props[0].pose[:2], world.pose[:2, 0]
    far = hypot(*(GOAL - box))
    behind = box - (GOAL - box) / far * (SIDE / 2 + 0.15)
    return far + hypot(*(robot - behind)) / 3


def outcome(world, plan):
    trial = world.fork(laws=False)
    for command in np.repeat(plan, HOLD, axis=1).T:
        trial.step(command[:, None])
    return cost(trial)


def control(world):
    best = np.zeros((2, COMMANDS))
    while hypot(*(world.props[0].pose[:2] - GOAL)) > NEAR:
        half = 2, COMMANDS, PLANS // 2
        near = best[:, :, None] + world.rng.normal(size=half) * FASTEST / 3
        anywhere = world.rng.uniform(-1, 1, half) * FASTEST
        plans = [best, *np.concatenate([near[:, :, 1:], anywhere], axis=2).transpose(2, 0, 1)]
        best = min(plans, key=lambda plan: outcome(world, plan))
        yield best[:, 0]
    world.stop(f"the box is at the goal after {world.time:.1f} s")


def checks(record):
    far = hypot(*(record.prop_pose[-1, :2, 0] - GOAL))
    yield Prediction("the box's distance from the goal", NEAR, far, 1e-3, "m", bound="at most")
