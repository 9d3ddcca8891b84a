"""Away: each runs straight away from the predator."""


def control(robot):
    return 100 * (robot.position - robot.world.position[:, 0])
