"""Edge: runs round along the edge of the arena."""

from math import hypot

RADIUS = 4.0  # m, of the arena


def control(robot):
    x, y = robot.position
    far = hypot(x, y)
    out = (RADIUS - far) / robot.sampling_time
    speed = robot.drive.max_linear_speed
    if out > speed:
        return 100 * x, 100 * y
    round_ = (speed**2 - out**2) ** 0.5
    return (out * x - round_ * y) / far, (out * y + round_ * x) / far
