"""Stray: runs after the one that is farthest from all others, where nobody is in the way."""

from math import dist


def control(robot):
    world, prey = robot.world, None
    while True:
        free = world.addons.game.free or world.addons.game.caught
        where = {k: world.position[:, k] for k in free}
        if prey not in where:
            alone = {k: sum(dist(where[k], other) for other in where.values()) for k in where}
            prey = max(alone, key=alone.get)
        yield 100 * (where[prey] - robot.position)
