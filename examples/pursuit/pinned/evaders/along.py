"""Along: pushes along the wall on which the two held less when they came, and never turns."""

from math import dist


def control(robot):
    ways = [o.position - robot.position for o in robot.neighbours]
    x, y = sum(way / dist(way, (0, 0)) for way in ways)
    while True:
        yield (100, 0) if x < y + 0.01 else (0, 100)
