"""Feint: runs round the guard one way, and after two seconds the other way."""

from math import asin, atan2, cos, hypot, sin

CLEAR, SECONDS = 0.41, 2.0  # m, between the middles of two robots that do not touch; s


def control(robot):
    x, y = robot.position
    (gx, gy), (px, py) = (other.position for other in robot.neighbours)
    apart, side = hypot(gx - x, gy - y), 1 if robot.time % (2 * SECONDS) < SECONDS else -1
    heading = atan2(py - y, px - x)
    if apart < hypot(px - x, py - y):
        heading = atan2(gy - y, gx - x) + side * asin(min(1.0, CLEAR / apart))
    return 100 * cos(heading), 100 * sin(heading)
