"""Straight: heads for the evader, through the pillar if need be, and slides along it."""


def control(robot):
    return 100 * (robot.neighbours[0].position - robot.position)  # m/s: its drive limits this
