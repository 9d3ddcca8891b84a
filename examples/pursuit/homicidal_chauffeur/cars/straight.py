"""Straight: steers to where the pedestrian is, and so may circle round it for ever."""

from math import atan2

from mars2d.geometry import wrap


def control(robot):
    x, y = robot.neighbours[0].position - robot.position
    return 0, wrap(atan2(y, x) - robot.pose[2]) / robot.sampling_time  # its drive limits this
