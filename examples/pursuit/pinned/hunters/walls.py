"""Walls: each goes to one of the walls, and pushes along it."""

APART = 0.4  # m, of the middles of two that touch


def control(robot):
    evader = next(other.position for other in robot.neighbours if other.name == "blue")
    along = (APART, 0) if robot.name == "red 1" else (0, APART)
    aside = evader + along - robot.position
    return 100 * (evader - robot.position if max(abs(aside)) < 0.02 else aside)
