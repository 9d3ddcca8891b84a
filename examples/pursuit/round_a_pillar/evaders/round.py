"""Round: runs round and round the pillar, from the pursuer's side away, and never turns."""

from math import atan2, cos, hypot, pi, sin

from mars2d.geometry import wrap


def control(robot):
    h = round(hypot(*robot.position), 3)  # m, of the circle about the pillar on which it starts
    px, py = robot.neighbours[0].position
    way = 1 if wrap(atan2(robot.position[1], robot.position[0]) - atan2(py, px)) > 0 else -1
    while True:
        x, y = robot.position
        heading = atan2(y, x) + way * (pi / 2 + 2 * min(1.0, max(-0.5, hypot(x, y) - h)))
        yield 100 * cos(heading), 100 * sin(heading)
