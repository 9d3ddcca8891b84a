"""Stubborn: chooses who is nearest, and runs after that one until it is caught."""

from math import dist


def control(robot):
    prey = None
    while True:
        world, free = robot.world, robot.world.addons.game.free
        if prey not in free:
            prey = min(free, key=lambda k: dist(world.position[:, k], robot.position), default=0)
        yield 100 * (world.position[:, prey] - robot.position)
