"""Lowest: heads for the point nearest to the line that it can reach before the guard.

Source: Isaacs, 1965, guarding a target.
"""

from mars2d.geometry import dominance

GUARD, CAPTURE = 0.5, 0.5  # m/s, of the guard; m, as the referee counts


def control(robot):
    guard, ratio = robot.neighbours[0].position, robot.drive.max_linear_speed / GUARD
    region = dominance(robot.position, guard, ratio, CAPTURE)
    lowest = region[:, region[1].argmin()]
    return 100 * (lowest - robot.position) - (0, 0.1)  # and down, if there is none
