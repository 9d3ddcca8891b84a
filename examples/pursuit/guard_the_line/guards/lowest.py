"""Lowest: heads for the point nearest to the line that the attacker can reach before it.

Source: Isaacs, 1965, guarding a target. It takes the attacker to be as fast as it has ever seen it.
"""

from math import dist

from mars2d.geometry import dominance

CAPTURE = 0.5  # m, as the referee counts


def control(robot):
    before, ratio = robot.neighbours[0].position, 0.1
    while True:
        here, top = robot.neighbours[0].position, robot.drive.max_linear_speed
        ratio = min(1.0, max(ratio, dist(here, before) / robot.sampling_time / top))
        region = dominance(here, robot.position, ratio, CAPTURE)
        yield 100 * (region[:, region[1].argmin()] - robot.position)
        before = here
