"""Besicovitch: runs at right angles to his radius, away from the lion, in shorter and shorter ways.

The squares of the ways have a finite sum, so he never gets to the edge; the ways have none.
Source: A. S. Besicovitch's, in J. E. Littlewood, A Mathematician's Miscellany, 1953.
"""

from math import hypot

RADIUS = 4.0  # m, of the arena


def control(robot):
    x, y = robot.position
    room, n = 0.9 * max(RADIUS**2 - x * x - y * y, 0), 0
    while True:
        x, y = robot.position
        lx, ly = robot.neighbours[0].position
        far = hypot(x, y) or 1.0
        side = -1.0 if x * ly - y * lx > 0 else 1.0  # away from the lion
        n += 1
        way = (room / n**1.5 / 2.612) ** 0.5  # the sum of n^-1.5 is 2.612
        while True:
            yield -100 * side * y / far, 100 * side * x / far
            way -= robot.drive.max_linear_speed * robot.sampling_time
            if way <= 0:
                break
