"""Behind: each runs to where the middle of the flock is between it and the predator."""

import numpy as np


def control(robot):
    predator, *others = (other.position for other in robot.neighbours)
    middle = np.mean([robot.position, *others], axis=0)
    away = middle - predator
    return 100 * (middle + 1.5 * away / max(float((away @ away) ** 0.5), 0.1) - robot.position)
