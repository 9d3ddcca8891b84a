"""Straight: runs to where the evader is."""


def control(robot):
    evader = next(other for other in robot.neighbours if other.name == "blue")
    return 100 * (evader.position - robot.position)  # m/s: its drive limits this
