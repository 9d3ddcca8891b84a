"""Rattle: pushes along one wall for a second, and then along the other."""


def control(robot):
    return (100, 0) if robot.time % 2 < 1 else (0, 100)
