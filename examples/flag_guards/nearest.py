"""Nearest: each guard runs straight at the attacker that is nearest to it."""

from math import dist


def control(robot):
    where = robot.world.position.T
    free = [where[k] for k in robot.world.addons.game.free] or [robot.position]
    return 100 * (min(free, key=lambda at: dist(at, robot.position)) - robot.position)
