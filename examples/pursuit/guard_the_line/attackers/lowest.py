"""Lowest: heads for the point nearest to the line that it can reach before the guard.

Source: Isaacs, 1965, guarding a target.
"""

import numpy as np

from mars2d.geometry import dominance

GUARD, CAPTURE, WALL = 0.5, 0.5, 6.8  # m/s, of the guard; m, as the referee counts; m, in x


def control(robot):
    guard, ratio = robot.neighbours[0].position, robot.drive.max_linear_speed / GUARD
    ways = dominance(robot.position, guard, ratio, CAPTURE).T - robot.position  # (360, 2)
    room = WALL - np.sign(ways[:, 0]) * robot.position[0]
    ways *= (room / np.maximum(abs(ways[:, 0]), 1e-9)).clip(0, 1)[:, None]
    return 100 * ways[ways[:, 1].argmin()] - (0, 0.1)  # and down, if there is none
