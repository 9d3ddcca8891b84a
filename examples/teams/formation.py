"""Formation: a team takes a shape and keeps it on its way, though each robot sees only two others.

Setting: distributed, partial information: its own pose, and those of its neighbours in a ring.
Law: the point h, AHEAD before a robot, can go any way: at u if v = (cos, sin).u and w = (-sin,
cos).u / AHEAD (feedback linearisation). u = (pace, 0) + gain sum of ((h_j - d_j) - (h - d)) over
its neighbours j: d are the places in the shape. Source: Oh, Park and Ahn, Automatica 53 (2015).
Prediction: after each sampling time dt, 1 - gain l dt is left of what is off, so it fades at about
gain l; l is the second eigenvalue of the graph's Laplacian (Fiedler, 1973), for a ring of six 1.
"""

from functools import partial
from math import cos, log, pi, sin

import numpy as np

from mars2d import Animation, Graph, Prediction, Robot, Scenario, Unicycle, addons

AHEAD, K = 0.2, np.arange(6) - 2.5  # m; the robots' numbers, counted from the middle
RING = np.roll(np.eye(6), 1, axis=0) + np.roll(np.eye(6), -1, axis=0)  # who sees whom
CIRCLE = np.array([np.cos(K * pi / 3), np.sin(K * pi / 3)])  # x, y in m
SHAPES = {"circle": CIRCLE, "wedge": [-0.6 * abs(K), 0.6 * K], "row": [0 * K, 0.6 * K]}


def aim(pose, place):
    return np.array([pose[0] + AHEAD * np.cos(pose[2]), pose[1] + AHEAD * np.sin(pose[2])]) - place


def join(places, gain, pace, robot):
    mine, theta = aim(robot.pose, places[:, robot.index]), robot.pose[2]
    x, y = gain * sum(aim(o.pose, places[:, o.index]) - mine for o in robot.neighbours) + [pace, 0]
    return cos(theta) * x + sin(theta) * y, (cos(theta) * y - sin(theta) * x) / AHEAD


def scenario(shape: str = "wedge", gain: float = 0.15, pace: float = 0.05):
    def predicted(scene, frame):
        goals = places.T + aim(starts, places).mean(axis=1) + np.array([pace * frame.time, 0])
        scene.line(goals, stroke="#7b3294", width=1.5, style="o:")

    places, starts = np.array(SHAPES[shape]), [*((2 + 0.5 * np.sin(2 * K)) * CIRCLE), 8.4 * K]
    law, drive = partial(join, places, gain, pace), Unicycle(max_linear_speed=5)
    return Scenario(
        title="Formation",
        robots=[*map(Robot(drive=drive, controller=law, sees="partial").at, *starts)],
        neighbours=Graph(RING),
        workspace=[(-3, -3), (-3, 3), (6, 3), (6, -3)],
        stop_time=60.0,
        addons=[addons.Trails(duration=20), addons.Theory(predicted)],
        animation=Animation(playback_speed=4, wake=False),
    )


def checks(record):
    (places, gain, _), dt = record.scenario.robots[0].controller.args, record.scenario.sampling_time
    off = np.ptp(aim(record.pose.swapaxes(0, 1), places[:, None]), axis=2).max(axis=0)  # (T,)
    gone = gain * dt * np.linalg.eigvalsh(np.diag(RING.sum(axis=1)) - RING)  # in a step, by mode
    if gone[1] > 0 and gone[-1] < 1 and (rate := -log(1 - gone[1]) / dt) * record.time[-1] > 4:
        k, end = np.searchsorted(record.time, [2 / rate, 4 / rate])
        fading = log(off[k] / off[end]) / (record.time[end] - record.time[k])
        yield Prediction.within("what is off fades at the rate", rate, fading, 5, "1/s")
