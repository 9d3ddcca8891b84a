"""Meet: comes out of the door, and runs at the escort to push it away from the prey."""


def control(robot):
    escort = next(other.position for other in robot.neighbours if other.name == "escort")
    return 100 * (escort - robot.position)
