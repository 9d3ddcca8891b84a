"""Stray: runs after the one that is farthest from all others, where nobody is in the way."""

from math import dist


def control(robot):
    free = list(robot.neighbours)
    while True:
        where = [other.position for other in free]
        alone = [sum(dist(at, other) for other in where) for at in where]
        prey = free[alone.index(max(alone))] if free else robot
        yield 100 * (prey.position - robot.position)
        while prey in free:
            if dist(prey.position, robot.position) <= 0.4:  # m: it is caught
                free.remove(prey)
            else:
                yield 100 * (prey.position - robot.position)
