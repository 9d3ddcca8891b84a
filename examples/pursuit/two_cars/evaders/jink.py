"""Jink: drives away, and when the other car is near turns off as tightly as it can."""

from math import atan2, cos, hypot, sin

from mars2d.geometry import wrap

NEAR = 0.8  # m


def control(robot):
    side = 0
    while True:
        other = robot.neighbours[0].pose
        x, y = robot.position - other[:2]
        ahead = cos(other[2]) * x + sin(other[2]) * y
        if hypot(x, y) > NEAR or ahead < 0:
            side = 0
        elif not side:
            left = cos(other[2]) * y - sin(other[2]) * x
            side = 100 if left >= 0 else -100
        yield 0, side or wrap(atan2(y, x) - robot.pose[2]) / robot.sampling_time
