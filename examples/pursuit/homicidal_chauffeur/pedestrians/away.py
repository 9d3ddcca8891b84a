"""Away: runs straight away from the car."""


def control(robot):
    return 100 * (robot.position - robot.neighbours[0].position)  # m/s: its drive limits this
