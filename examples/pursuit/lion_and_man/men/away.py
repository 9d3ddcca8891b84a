"""Away: runs straight away from the lion, and along the edge where that is in his way."""

from math import hypot

RADIUS = 4.0  # m, of the arena


def control(robot):
    x, y = robot.position
    dx, dy = robot.position - robot.neighbours[0].position
    if hypot(x, y) > RADIUS - 0.1 and x * dx + y * dy > 0:
        side = 1.0 if x * dy - y * dx >= 0 else -1.0
        dx, dy = -side * y - 0.1 * x, side * x - 0.1 * y
    return 100 * dx, 100 * dy
