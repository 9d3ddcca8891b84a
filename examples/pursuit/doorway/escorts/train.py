"""Train: escort and prey push one behind the other; beyond the door the escort holds the guard."""

from math import dist


def control(robot):
    (x, y), team = robot.position, {other.name: other.position for other in robot.neighbours}
    guard = team["guard"]
    in_door = abs(guard[0]) < 0.3
    if robot.name == "escort":
        return (100, -1000 * y) if in_door else 100 * (guard - robot.position)
    if in_door or (x < -0.5 and abs(y) > 0.05):
        return 100, -1000 * y
    if x < 0.5 or dist(guard, robot.position) > 1 or guard[0] < x:
        return 100, -100 * y * (x < 0.5)
    return 50, 100 if y > guard[1] else -100  # round the guard
