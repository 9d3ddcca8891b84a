"""Inside: heads for a point between the evader and the middle, and so has the shorter way round."""

from math import dist


def control(robot):
    here = robot.neighbours[0].position
    inwards = min(0.3, dist(here, robot.position) / 10)  # in shares of the way to the middle
    return 100 * ((1 - inwards) * here - robot.position)
