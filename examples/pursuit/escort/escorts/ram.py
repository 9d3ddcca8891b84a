"""Ram: runs at the hunter, to push it away before it comes near."""


def control(robot):
    return 100 * (robot.neighbours[0].position - robot.position)  # m/s: its drive limits this
