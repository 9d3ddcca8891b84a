"""Zigzag: runs away, to one side for two seconds and then to the other."""


def control(robot):
    while True:
        x, y = robot.position - robot.neighbours[0].position
        side = 1 if robot.time % 4 < 2 else -1
        yield 100 * (x - side * y), 100 * (y + side * x)
