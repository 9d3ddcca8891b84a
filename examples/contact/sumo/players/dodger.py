"""Dodger: waits at the rim like a matador, steps aside at the last moment, pushes from inside."""

from math import atan2, cos, hypot, pi

from mars2d.geometry import wrap

PLACE = 1.2  # m, from the middle of the ring


def control(robot):
    side = robot.rng.choice([-1, 1])  # to step to
    near = robot.rng.uniform(0.4, 0.7)  # m, too near
    while True:
        x, y, heading = robot.pose
        other_x, other_y, _ = robot.neighbours[0].pose
        if hypot(other_x - x, other_y - y) > near:  # go to the rim, and wait, turned to go along it
            waits = hypot(x, y) > PLACE
            aim = atan2(y, x) + waits * side * pi / 2
        elif hypot(other_x, other_y) > hypot(x, y):  # the other is farther out: push
            waits, aim = False, atan2(other_y - y, other_x - x)
        else:
            waits, aim = False, atan2(y, x) + side * 1.9  # along the rim, and a little inwards
        error = wrap(aim - heading)
        yield (0.0 if waits else cos(error)), 6 * error
