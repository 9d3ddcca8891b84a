"""Across: runs straight on, at right angles to the line of sight at the start."""


def control(robot):
    x, y = robot.position - robot.neighbours[0].position
    while True:
        yield -100 * y, 100 * x  # m/s: its drive limits this
