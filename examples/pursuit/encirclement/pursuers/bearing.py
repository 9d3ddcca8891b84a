"""Bearing: keeps the evader's bearing; if that is too quick across, it gets as near as it can."""

import numpy as np


def control(robot):
    evader = next(other for other in robot.neighbours if other.name == "blue")
    before, most = evader.position, robot.drive.max_linear_speed
    while True:
        here = evader.position
        sight = here - robot.position
        sight /= np.hypot(*sight)
        velocity = (here - before) / robot.sampling_time
        across = velocity - (velocity @ sight) * sight
        ahead = max(most**2 - across @ across, 0) ** 0.5
        if ahead > max(velocity @ sight, 0):  # the way to a meeting
            yield across + ahead * sight
        else:  # as near as it can: at the angle acos(most / speed) to the evader's way
            ahead = velocity / np.hypot(*velocity)
            side = sight - (sight @ ahead) * ahead
            share = min(most / np.hypot(*velocity), 1)
            yield most * (share * ahead + (1 - share**2) ** 0.5 * side / np.hypot(*side))
        before = here
