"""To and fro: as circle, but turns round every four seconds to surprise the hider."""

from math import atan2, cos, hypot, pi, sin

SECONDS = 4.0


def control(robot):
    radius = round(hypot(*robot.sense.pose[:2]), 3)  # m, of the circle on which it starts
    while True:
        (x, y, _), way = robot.sense.pose, 1 if robot.time % (2 * SECONDS) < SECONDS else -1
        heading = atan2(y, x) + way * (pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - radius)))
        yield 100 * cos(heading), 100 * sin(heading)
