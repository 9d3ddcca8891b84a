"""Lead: proportional navigation, turns four times as quickly as the line of sight does."""

from math import atan2

from mars2d.geometry import wrap

GAIN = 4.0


def control(robot):
    x, y = robot.neighbours[0].position - robot.position
    before = atan2(y, x)
    while True:
        x, y = robot.neighbours[0].position - robot.position
        sight = atan2(y, x)
        off = wrap(sight - robot.pose[2])
        turn = GAIN * wrap(sight - before) / robot.sampling_time
        yield 0, turn if abs(off) < 1 else off / robot.sampling_time  # behind it: turn round first
        before = sight
