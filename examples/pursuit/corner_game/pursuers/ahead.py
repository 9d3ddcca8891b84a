"""Ahead: heads for where the evader is going to be, if it goes on as it does now."""

from math import dist


def control(robot):
    before = robot.neighbours[0].position
    while True:
        here = robot.neighbours[0].position
        velocity = (here - before) / robot.sampling_time
        time = dist(here, robot.position) / robot.drive.max_linear_speed
        yield 100 * (here + time * velocity - robot.position)
        before = here
