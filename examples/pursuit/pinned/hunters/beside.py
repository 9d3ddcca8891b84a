"""Beside: the two stand side by side in the middle of the corner, and push at the evader."""

from math import cos, dist, radians, sin

APART = 0.4  # m, of the middles of two that touch
ANGLES = radians(15), radians(75)  # to the wall below


def control(robot):
    evader = next(other.position for other in robot.neighbours if other.name == "blue")
    angle = ANGLES[robot.name == "red 2"]
    aside = (APART * cos(angle), APART * sin(angle)) - (robot.position - evader)
    at_it = dist(robot.position, evader) < APART + 0.02
    return 100 * ((evader - robot.position) + aside if at_it else aside)
