"""Away: turns its back to the other car, and drives away."""

from math import atan2

from mars2d.geometry import wrap


def control(robot):
    x, y = robot.position - robot.neighbours[0].position
    return 0, wrap(atan2(y, x) - robot.pose[2]) / robot.sampling_time
