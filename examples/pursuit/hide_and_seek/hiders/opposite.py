"""Opposite: by what it hears it keeps the pillar between itself and the seeker."""

from math import atan2, cos, hypot, pi, sin

from mars2d.geometry import wrap


def control(robot):
    radius = round(hypot(*robot.sense.pose[:2]), 3)  # m, of the circle on which it starts
    while True:
        (x, y, theta), heard = robot.sense.pose, robot.sense.range_bearing[0]
        angle = theta + heard.bearing
        seeker = atan2(y + heard.range * sin(angle), x + heard.range * cos(angle))
        ahead = float(wrap(atan2(y, x) - seeker))
        way = 1 if ahead > 0 else -1
        heading = atan2(y, x) + way * (pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - radius)))
        speed = 100 * min(1.0, 20 * (pi - abs(ahead)))  # slower and slower towards the other side
        yield speed * cos(heading), speed * sin(heading)
