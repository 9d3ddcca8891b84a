"""To and fro: runs round the pillar, and turns round every three seconds to surprise the evader."""

from math import atan2, cos, hypot, pi, sin

RADIUS, SECONDS = 1.75, 3.0  # m, of the circle on which it runs; s


def control(robot):
    x, y = robot.position
    way = 1 if robot.time % (2 * SECONDS) < SECONDS else -1
    heading = atan2(y, x) + way * (pi / 2 + 2 * min(1.0, max(-0.5, hypot(x, y) - RADIUS)))
    return 100 * cos(heading), 100 * sin(heading)
