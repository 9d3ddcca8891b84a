"""Shortest: takes the shortest way round the pillar: a tangent, and then along the circle."""

from math import acos, atan2, cos, hypot, pi, sin

from mars2d.geometry import wrap


def control(robot):
    h = round(hypot(*robot.position), 3)  # m, of the circle about the pillar on which it starts
    while True:
        (x, y), (ex, ey) = robot.position, robot.neighbours[0].position
        rho, angle = hypot(x, y), atan2(y, x)
        apart = float(wrap(atan2(ey, ex) - angle))
        way = 1 if apart > 0 else -1
        out = acos(min(1.0, h / rho))  # the angle from here to the tangent's end
        heading = angle + way * (pi / 2 + out) + way * 2 * min(0.0, rho - h)
        if abs(apart) <= out + acos(min(1.0, h / hypot(ex, ey))):
            yield 100 * (ex - x), 100 * (ey - y)  # nothing in between
        else:
            yield 100 * cos(heading), 100 * sin(heading)
