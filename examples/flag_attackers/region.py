"""Region: each heads for the point nearest to the flag that it reaches before any guard."""

from math import dist

import numpy as np

from mars2d.geometry import dominance

FLAG, CAPTURE = np.array([-4.0, 0.0]), 0.5  # m


def control(robot):
    game, best = robot.world.addons.game, np.inf
    for guard in game.hunters:
        other = robot.world.robots[guard]
        ratio = robot.drive.max_linear_speed / other.drive.max_linear_speed
        way = dominance(robot.position, other.position, min(ratio, 1.0), CAPTURE)
        best = np.minimum(best, np.sqrt(((way.T - robot.position) ** 2).sum(axis=1)))
    far = dist(FLAG, robot.position) + 1
    ahead = (way.T - robot.position) / np.sqrt(((way.T - robot.position) ** 2).sum(axis=1))[:, None]
    ends = np.minimum(best, far)[:, None] * ahead + robot.position
    goal = ends[((ends - FLAG) ** 2).sum(axis=1).argmin()]
    return 100 * (goal - robot.position) + (FLAG - robot.position)
