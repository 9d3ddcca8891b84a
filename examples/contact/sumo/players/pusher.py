"""Pusher: charges like a bull, at full speed and a little at random, and never minds the rim."""

from math import atan2

from mars2d.geometry import wrap


def control(robot):
    x, y, heading = robot.pose
    other_x, other_y, _ = robot.neighbours[0].pose
    bearing = wrap(atan2(other_y - y, other_x - x) - heading)
    return 1.0, 6 * bearing + robot.rng.normal()
