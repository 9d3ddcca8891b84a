"""Matador: lets the car come, steps aside at the last moment, and then keeps clear of its flank."""

from math import cos, hypot, sin

SPEED, RADIUS = 1.0, 2.0  # m/s and m, of the car: the rules of the game


def control(robot):
    ratio, side = robot.drive.max_linear_speed / SPEED, None
    while True:
        car = robot.neighbours[0]
        x, y = robot.position - car.position
        c, s = cos(car.pose[2]), sin(car.pose[2])
        ahead, left = c * x + s * y, c * y - s * x
        if ahead < 0 or hypot(x, y) > ratio * RADIUS:  # there Isaacs' barrier is narrowest
            side = None
            yield 0, 0
        elif ahead < ratio * hypot(x, y):  # the car can't come nearer, if one runs from it
            side = None
            yield 100 * x, 100 * y  # m/s: its drive limits this
        else:
            side = side or ((-100 * s, 100 * c) if left >= 0 else (100 * s, -100 * c))
            yield side
