"""Straight: goes for the prey, and pushes whatever is in between."""


def control(robot):
    return 100 * (robot.neighbours[1].position - robot.position)  # m/s: its drive limits this
