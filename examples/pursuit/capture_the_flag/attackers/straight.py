"""Straight: each runs straight to the flag, then straight home."""

from math import dist

FLAG, REACH, HOME = (-4.0, 0.0), 0.45, 4.0  # m; home is on the right


def control(robot):
    while dist(robot.position, FLAG) > REACH:
        yield 100 * (FLAG - robot.position)  # m/s: its drive limits this
    while True:
        yield 100 * (HOME - robot.position[0]), 0
