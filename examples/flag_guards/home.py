"""Home: all guards stay a metre from the flag, towards the attackers that are nearest to it."""

from math import dist

import numpy as np

FLAG = np.array([-4.0, 0.0])


def control(robot):
    game, where = robot.world.addons.game, robot.world.position.T
    free = sorted((where[k] for k in game.free or game.caught), key=lambda at: dist(at, FLAG))
    at = free[game.hunters.index(robot.index) % len(free)]
    return 100 * (FLAG + (at - FLAG) / max(dist(at, FLAG), 1) - robot.position)
