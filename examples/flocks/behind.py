"""Behind: each runs to where the middle of the flock is between it and the predator."""

import numpy as np


def control(robot):
    game, where = robot.world.addons.game, robot.world.position
    middle = np.mean([where[:, k] for k in game.free or (robot.index,)], axis=0)
    away = middle - where[:, 0]
    return 100 * (middle + 1.5 * away / max(float((away @ away) ** 0.5), 0.1) - robot.position)
