"""Swerve: whom it has missed it leaves behind, and comes back from afar, head on."""

from math import atan2, cos, hypot, sin

from mars2d.geometry import wrap

FAR = 8.0  # m, at which it turns back: two turning circles


def control(robot):
    leaves = False
    while True:
        x, y = robot.neighbours[0].position - robot.position
        theta = robot.pose[2]
        leaves = (leaves or cos(theta) * x + sin(theta) * y < 0) and hypot(x, y) < FAR
        yield 0, 0 if leaves else wrap(atan2(y, x) - theta) / robot.sampling_time
