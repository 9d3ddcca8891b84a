"""Aside: runs down, and the more aside from the guard, the nearer that is."""

from math import dist


def control(robot):
    x, y = robot.position - robot.neighbours[0].position
    near = 2 / max(dist((x, y), (0, 0)), 0.1)
    side = 1 if x > 0 else -1
    return 100 * near * side * (abs(robot.position[0]) < 6.6), -100.0
