"""Inside: runs to the middle of the nearer circle that the car can't turn into."""

from math import cos, sin

RADIUS = 2.0  # m, of the car's tightest turn: the rules of the game


def control(robot):
    car = robot.neighbours[0]
    x, y = robot.position - car.position
    c, s = cos(car.pose[2]), sin(car.pose[2])
    side = RADIUS if c * y - s * x >= 0 else -RADIUS
    return 100 * (-side * s - x), 100 * (side * c - y)  # m/s: its drive limits this
