"""Bearing: constant bearing, goes across the line of sight as fast as the evader does."""

import numpy as np


def control(robot):
    before = robot.neighbours[0].position
    while True:
        here = robot.neighbours[0].position
        sight = (here - robot.position) / np.hypot(*(here - robot.position))
        velocity = (here - before) / robot.sampling_time
        across = velocity - (velocity @ sight) * sight
        ahead = max(robot.drive.max_linear_speed**2 - across @ across, 0) ** 0.5
        yield across + ahead * sight
        before = here
