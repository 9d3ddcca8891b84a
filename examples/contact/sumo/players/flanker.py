"""Flanker: keeps away from the other's front, gets behind it, and pushes it the way it looks."""

from math import atan2, cos, pi, sin

from mars2d.geometry import wrap


def control(robot):
    side = robot.rng.choice([-1, 1])  # to go round it by
    while True:
        x, y, heading = robot.pose
        other_x, other_y, other_heading = robot.neighbours[0].pose
        bearing = atan2(other_y - y, other_x - x)
        if abs(wrap(bearing - other_heading)) > pi / 3:  # not behind it: to its side, then its back
            away = other_heading + side * 2
            bearing = atan2(other_y + 0.5 * sin(away) - y, other_x + 0.5 * cos(away) - x)
        error = wrap(bearing - heading)
        yield cos(error), 6 * error
