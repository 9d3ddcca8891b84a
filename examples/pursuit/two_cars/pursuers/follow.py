"""Follow: steers to where the other car is."""

from math import atan2

from mars2d.geometry import wrap


def control(robot):
    x, y = robot.neighbours[0].position - robot.position
    return 0, wrap(atan2(y, x) - robot.pose[2]) / robot.sampling_time  # its drive limits this
