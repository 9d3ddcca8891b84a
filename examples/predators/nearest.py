"""Nearest: runs at whoever is nearest, and changes its mind whenever another one is."""

from math import dist


def control(robot):
    free = robot.world.addons.game.free or robot.world.addons.game.caught
    where = [robot.world.position[:, k] for k in free]
    return 100 * (min(where, key=lambda at: dist(at, robot.position)) - robot.position)
