"""Aimed: steers to where the pedestrian is going to be when the car gets there."""

from math import atan2, dist

from mars2d.geometry import wrap


def control(robot):
    before = robot.neighbours[0].position
    while True:
        here = robot.neighbours[0].position
        time = dist(here, robot.position) / robot.drive.max_linear_speed
        x, y = here + time * (here - before) / robot.sampling_time - robot.position
        yield 0, wrap(atan2(y, x) - robot.pose[2]) / robot.sampling_time
        before = here
