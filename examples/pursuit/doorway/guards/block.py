"""Block: stands in the door and pushes back; who is pushed out of it keeps before the prey."""


def control(robot):
    (x, y), team = robot.position, {other.name: other.position for other in robot.neighbours}
    if x < 0.3:
        return -10 * x, -10 * y
    return 100 * (team["prey"] + (0.4, 0) - robot.position)
