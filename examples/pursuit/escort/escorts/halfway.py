"""Halfway: goes to the middle between hunter and prey, where it can see both."""


def control(robot):
    hunter, prey = (other.position for other in robot.neighbours)
    return 5 * ((hunter + prey) / 2 - robot.position)
