"""Straight: each runs straight to the flag."""

import numpy as np

FLAG = np.array([-4.0, 0.0])


def control(robot):
    return 100 * (FLAG - robot.position)  # m/s: its drive limits this
