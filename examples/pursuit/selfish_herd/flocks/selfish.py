"""Selfish: each runs to its nearest neighbour, to have somebody between it and the predator.

Source: Hamilton, J. theor. Biol. 31, 1971.
"""

from math import dist


def control(robot):
    others = [other.position for other in robot.neighbours[1:]] or [robot.position]
    return 100 * (min(others, key=lambda at: dist(at, robot.position)) - robot.position)
