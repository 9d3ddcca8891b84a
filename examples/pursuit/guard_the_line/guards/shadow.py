"""Shadow: runs along the line, to the place straight below the attacker, and waits there."""

LINE = -1.8  # m, its y


def control(robot):
    x, y = robot.neighbours[0].position
    return 100 * ((x, min(y, LINE + 0.5)) - robot.position)
