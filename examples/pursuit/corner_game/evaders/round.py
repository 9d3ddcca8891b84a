"""Round: runs round a circle, the other way round when the pursuer comes from ahead."""

from math import atan2, cos, sin

import numpy as np

from mars2d.geometry import wrap

RADIUS = 4.3  # m, about the middle
TOO_NEAR = 0.5  # rad, between the evader and a pursuer ahead of it


def control(robot):
    way = 1  # counter-clockwise
    while True:
        angle, other = (atan2(y, x) for x, y in (robot.position, robot.neighbours[0].position))
        if 0 < way * wrap(other - angle) < TOO_NEAR:
            way = -way
        ahead = angle + 0.3 * way
        yield 100 * (RADIUS * np.array([cos(ahead), sin(ahead)]) - robot.position)
