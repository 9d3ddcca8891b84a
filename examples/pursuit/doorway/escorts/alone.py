"""Alone: the escort pushes alone, and the prey waits until the door is free."""


def control(robot):
    (x, y), team = robot.position, {other.name: other.position for other in robot.neighbours}
    guard = team["guard"]
    if robot.name == "escort":
        return 100 * (guard - robot.position)
    free = abs(guard[0]) > 0.6 or guard[0] < x
    return (100 if free else -100 * (x > -1.5)), -100 * y * (x < 0.5)
