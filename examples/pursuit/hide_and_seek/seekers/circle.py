"""Circle: runs round the pillar as near as it can, always the same way."""

from math import atan2, cos, hypot, pi, sin


def control(robot):
    radius = round(hypot(*robot.sense.pose[:2]), 3)  # m, of the circle on which it starts
    while True:
        x, y, _ = robot.sense.pose
        heading = atan2(y, x) + pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - radius))
        yield 100 * cos(heading), 100 * sin(heading)
