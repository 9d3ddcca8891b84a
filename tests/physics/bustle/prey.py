"""The prey: it flees from the nearest neighbour, and remembers for how long."""

import numpy as np


def length(vector):
    return np.hypot(*vector)


def control(robot):
    robot.memory.steps = 0
    while True:
        robot.memory.steps += 1
        nearest = min(
            robot.neighbours, key=lambda other: np.hypot(*(other.position - robot.position))
        )
        away = robot.position - nearest.position
        yield 0.3 * away / np.hypot(*away) + 0.1 * robot.rng.normal(size=2)
