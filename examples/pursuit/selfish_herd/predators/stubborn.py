"""Stubborn: chooses who is nearest, and runs after that one until it is caught."""

from math import dist


def control(robot):
    free = list(robot.neighbours)
    while True:
        prey = min(free, key=lambda at: dist(at.position, robot.position), default=robot)
        yield 100 * (prey.position - robot.position)
        while prey in free:
            if dist(prey.position, robot.position) <= 0.4:  # m: it is caught
                free.remove(prey)
            else:
                yield 100 * (prey.position - robot.position)
