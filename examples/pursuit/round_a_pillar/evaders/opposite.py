"""Opposite: keeps the pillar between itself and the pursuer, and stands while it is opposite."""

from math import atan2, cos, hypot, pi, sin

from mars2d.geometry import wrap


def control(robot):
    h = round(hypot(*robot.position), 3)  # m, of the circle about the pillar on which it starts
    while True:
        (x, y), (px, py) = robot.position, robot.neighbours[0].position
        ahead = float(wrap(atan2(y, x) - atan2(py, px)))
        way = 1 if ahead > 0 else -1
        heading = atan2(y, x) + way * (pi / 2 + 2 * min(1.0, max(-0.5, hypot(x, y) - h)))
        speed = 100 * min(1.0, 20 * (pi - abs(ahead)))  # slower and slower towards the other side
        yield speed * cos(heading), speed * sin(heading)
