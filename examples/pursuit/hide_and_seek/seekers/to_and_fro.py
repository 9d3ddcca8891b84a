"""To and fro: as circle, but turns round every four seconds to surprise the hider."""

from math import atan2, cos, hypot, pi, sin

RADIUS, SECONDS = 2.05, 4.0  # m, of the circle on which it runs; s


def control(robot):
    (x, y, _), way = robot.sense.pose, 1 if robot.time % (2 * SECONDS) < SECONDS else -1
    heading = atan2(y, x) + way * (pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - RADIUS)))
    return 100 * cos(heading), 100 * sin(heading)
