"""To and fro: runs round the pillar, and turns round every three seconds to surprise the evader."""

from math import atan2, cos, hypot, pi, sin

SECONDS = 3.0


def control(robot):
    h = round(hypot(*robot.position), 3)  # m, of the circle about the pillar on which it starts
    while True:
        x, y = robot.position
        way = 1 if robot.time % (2 * SECONDS) < SECONDS else -1
        heading = atan2(y, x) + way * (pi / 2 + 2 * min(1.0, max(-0.5, hypot(x, y) - h)))
        yield 100 * cos(heading), 100 * sin(heading)
