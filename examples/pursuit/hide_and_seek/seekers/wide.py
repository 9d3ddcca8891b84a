"""Wide: runs round far from the pillar, from where it sees more behind it, but turns slowly."""

from math import atan2, cos, hypot, pi, sin

FARTHER = 1.25  # m, from the pillar than it starts


def control(robot):
    radius = round(hypot(*robot.sense.pose[:2]), 3) + FARTHER
    while True:
        x, y, _ = robot.sense.pose
        heading = atan2(y, x) + pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - radius))
        yield 100 * cos(heading), 100 * sin(heading)
