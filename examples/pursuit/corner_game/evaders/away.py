"""Away: runs straight away from the pursuer, and along the walls where they are in its way."""

import numpy as np


def control(robot):
    away = robot.position - robot.neighbours[0].position
    blocked = (abs(robot.position) > 4.6) & (robot.position * away > 0)
    return 100 * np.where(blocked, 0.0, away)
