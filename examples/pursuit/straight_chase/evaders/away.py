"""Away: runs straight away from the pursuer."""


def control(robot):
    return 100 * (robot.position - robot.neighbours[0].position)
