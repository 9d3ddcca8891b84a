"""Circle: runs round the pillar as near as it can, always the same way."""

from math import atan2, cos, hypot, pi, sin

RADIUS = 2.05  # m, of the circle about the pillar on which it runs


def control(robot):
    x, y, _ = robot.sense.pose
    heading = atan2(y, x) + pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - RADIUS))
    return 100 * cos(heading), 100 * sin(heading)
