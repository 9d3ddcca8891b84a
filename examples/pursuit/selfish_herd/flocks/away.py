"""Away: each runs straight away from the predator, which is the first of its neighbours."""


def control(robot):
    return 100 * (robot.position - robot.neighbours[0].position)
