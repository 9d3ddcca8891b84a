"""Straight: runs to where the man is."""


def control(robot):
    return 100 * (robot.neighbours[0].position - robot.position)  # m/s: its drive limits this
