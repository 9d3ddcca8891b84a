"""Selfish: each runs to its nearest neighbour, to have somebody between it and the predator.

Source: Hamilton, J. theor. Biol. 31, 1971.
"""

from math import dist


def control(robot):
    game, where = robot.world.addons.game, robot.world.position
    others = [where[:, k] for k in game.free if k != robot.index]
    near = min(others, key=lambda at: dist(at, robot.position), default=robot.position)
    return 100 * (near - robot.position)
