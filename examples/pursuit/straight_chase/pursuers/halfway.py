"""Halfway: aims ahead of the evader by half the time that it would take to get there."""

from math import dist


def control(robot):
    before = robot.neighbours[0].position
    while True:
        here = robot.neighbours[0].position
        velocity = (here - before) / robot.sampling_time
        time = dist(here, robot.position) / robot.drive.max_linear_speed
        yield 100 * (here + time / 2 * velocity - robot.position)
        before = here
