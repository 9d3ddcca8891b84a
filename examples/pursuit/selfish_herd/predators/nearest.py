"""Nearest: runs at whoever is nearest, and changes its mind whenever another one is."""

from math import dist

CAPTURE = 0.4  # m


def control(robot):
    out = set()  # those that have been caught
    while True:
        away = {other: dist(other.position, robot.position) for other in robot.neighbours}
        out |= {other.name for other in away if away[other] <= CAPTURE}
        free = [other for other in away if other.name not in out]
        prey = min(free, key=away.get, default=robot)
        yield 100 * (prey.position - robot.position)
