"""Radius: keeps on the radius that the man is on, and comes outwards as fast as it can."""

from math import hypot


def control(robot):
    way = robot.drive.max_linear_speed * robot.sampling_time
    while True:
        (x, y), (mx, my) = robot.position, robot.neighbours[0].position
        far = hypot(mx, my) or 1.0
        ux, uy = mx / far, my / far  # the radius
        along, off = ux * x + uy * y, ux * y - uy * x
        along = min(along + max(way**2 - off**2, 0) ** 0.5, far)
        yield (along * ux - x) / robot.sampling_time, (along * uy - y) / robot.sampling_time
