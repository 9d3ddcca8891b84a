"""Away: runs away from all pursuers, from the nearest the most."""

import numpy as np


def control(robot):
    away = np.array([robot.position - other.position for other in robot.neighbours])
    return 100 * (away / (away**2).sum(axis=1, keepdims=True)).sum(axis=0)
