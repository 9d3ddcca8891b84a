"""Cyclic pursuit: each robot chases the next one, and the last one the first.

Setting: distributed, partial information: own pose, and the position of one other robot.
Question: n robots chase each other. Do they meet, part, or go round and round?
Law: v = min(speed, k_r r), w = k_a a: r [m] is how far the other one is, a [rad] where, from ahead.
Source: Marshall, Broucke and Francis, IEEE Transactions on Automatic Control 49(11), 2004.
Prediction: k_a / k_r against (2 n / pi) sin(pi / n) decides, 1.91 for six. Above it they shrink to
a point, below it they spread until all go at `speed`: then evenly on a circle of the radius
n speed / (pi k_a). The MARS paper (Fig. 7: n = 6, in the end a circle) gives no gains, nor whether
speed is bounded: here it is, and gain = k_a and ratio = k_a / k_r are ours.
"""

from functools import partial
from math import atan2, ceil, cos, hypot, pi, sin

import numpy as np

from mars2d import Animation, Graph, Prediction, Robot, Scenario, Unicycle
from mars2d.addons import Theory
from mars2d.geometry import wrap


def pursue(gain, speed, ratio, robot):
    dx, dy = robot.neighbours[0].position - robot.position
    return min(speed, gain / ratio * hypot(dx, dy)), gain * wrap(atan2(dy, dx) - robot.pose[2])


def scenario(n=6, gain=0.1, speed=0.05, ratio=1.0, gap=2.0):  # -, 1/s, m/s, -, m at the start
    def predicted(scene, frame):
        scene.circle(frame.pose[:2].mean(axis=1), n * speed / pi / gain, stroke="#7b3294", width=2)

    law, drive = partial(pursue, gain, speed, ratio), Unicycle(max_linear_speed=10)
    robot, robots = Robot(diameter=0.2, drive=drive, controller=law, sees="positions"), []
    for k in range(n):
        angle, away = 2 * pi * k / n, gap / 2 / sin(pi / n) * (1 + 0.3 * sin(2.3 * k + 1))
        robots.append(robot.at(away * cos(angle), away * sin(angle), 2.4 * k))
    return Scenario(
        title="Cyclic pursuit",
        robots=robots,
        neighbours=Graph((n, [(k, (k + 1) % n) for k in range(n)])),
        workspace=ceil(0.7 * gap / sin(pi / n)) * np.array([(-1, -1), (-1, 1), (1, 1), (1, -1)]),
        on_exit="ignore",
        stop_time=500.0,
        addons=[Theory(predicted)] if ratio < 2 * n / pi * sin(pi / n) else [],
        animation=Animation(playback_speed=20),
    )


def checks(record):
    law, h = record.scenario.robots[0].controller, pi / len(record.scenario.robots)
    (gain, speed, ratio), fast = law.args, record.command[:, 0] > 0.999 * law.args[1]  # (T, n)
    x, y = (record.pose[:, :2] - record.pose[:, :2].mean(axis=2, keepdims=True)).swapaxes(0, 1)
    away, half, below = np.hypot(x, y).mean(axis=1), len(x) // 2, 2 / h * sin(h) - ratio
    if fast[half:].all() and below > 0 and record.time[half] > 2 * pi / (h * gain):
        radius, gaps = speed / (h * gain), np.hypot(x - np.roll(x, 1, 1), y - np.roll(y, 1, 1))
        yield Prediction.within("radius", radius, away[-1], 1, "m")
        yield Prediction.within("largest gap", 2 * radius * sin(h), gaps[-1].max(), 5, "m")
    elif not fast[half:].any():
        yield Prediction("growth: 1 or -1", np.sign(below), np.sign(away[-1] - away[half]), 0)
