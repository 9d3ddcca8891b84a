"""Corners: runs between four points, at each to that neighbour which is farther from the pursuer.

Source: the evader of Casini and Garulli, 2016, 5.1.
"""

from math import dist

import numpy as np

POINTS = 4.5 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])


def control(robot):
    k = min(range(4), key=lambda j: dist(POINTS[j], robot.position))
    while True:
        if dist(POINTS[k], robot.position) < 0.05:
            hunter = robot.neighbours[0].position
            k = max((k + 1) % 4, (k - 1) % 4, key=lambda j: dist(POINTS[j], hunter))
        yield 100 * (POINTS[k] - robot.position)
