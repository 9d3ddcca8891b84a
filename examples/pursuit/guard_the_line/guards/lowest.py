"""Lowest: heads for the point nearest to the line that the attacker can reach before it.

Source: Isaacs, 1965, guarding a target. It takes the attacker to be as fast as it has ever seen it.
"""

from math import dist

import numpy as np

from mars2d.geometry import dominance

CAPTURE, WALL = 0.5, 6.8  # m, as the referee counts; m, in x


def control(robot):
    before, ratio = robot.neighbours[0].position, 0.1
    while True:
        here, top = robot.neighbours[0].position, robot.drive.max_linear_speed
        ratio = min(1.0, max(ratio, dist(here, before) / robot.sampling_time / top))
        ways = dominance(here, robot.position, ratio, CAPTURE).T - here  # (360, 2)
        room = WALL - np.sign(ways[:, 0]) * here[0]
        ways *= (room / np.maximum(abs(ways[:, 0]), 1e-9)).clip(0, 1)[:, None]
        yield 100 * (here + ways[ways[:, 1].argmin()] - robot.position)
        before = here
