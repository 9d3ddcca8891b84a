"""Region: to the point nearest to the flag that it reaches before any guard; then home."""

from math import dist

import numpy as np

from mars2d.geometry import dominance

FLAG, REACH, HOME = np.array([[-4.0], [0.0]]), 0.45, 4.0  # m; home is on the right
GUARD, CAPTURE = 0.5, 0.5  # m/s; m


def control(robot):
    while dist(FLAG[:, 0], robot.position) > REACH:
        here, ratio = robot.position[:, None], min(1.0, robot.drive.max_linear_speed / GUARD)
        guards = [other.position for other in robot.neighbours if other.name.startswith("guard")]
        edges = [dominance(robot.position, at, ratio, CAPTURE) - here for at in guards]
        lengths = np.sqrt([(edge**2).sum(axis=0) for edge in edges])
        ways = edges[0] / np.maximum(lengths[0], 1e-9)
        far = dist(FLAG[:, 0], robot.position) + 1
        ends = here + np.minimum(lengths.min(axis=0), far) * ways
        goal = ends[:, ((ends - FLAG) ** 2).sum(axis=0).argmin()]
        yield 100 * (goal - robot.position) + (FLAG[:, 0] - robot.position)
    while True:
        yield 100 * (HOME - robot.position[0]), 0
