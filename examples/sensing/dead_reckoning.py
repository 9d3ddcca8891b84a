"""Dead reckoning: robots count the turns of their wheels, and estimate when they are back home.

Setting: distributed, sensors only: each steers by its odometry, round a rectangle and back. It is
one run many times over: robots, drawn as points, that start together and don't feel each other.
Question: how far is a robot from its estimated position?
Prediction: a wheel is off by drift sqrt(s) after s metres. After a straight way L, a robot with
wheels B beside its middle is off by drift sqrt(L^3 / 6) / B across it: the heading goes first. The
covariance of (x, y, theta) grows from step to step, P' = F P F^T + G Q G^T, to first order. Its
ellipse, drawn for one robot, holds 95 % of them; of all errors e the mean of e^T P^-1 e is 3.
Source: R. Siegwart et al., Introduction to Autonomous Mobile Robots (2011), section 5.2.4.
"""

from math import atan2, cos, hypot, sqrt

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle
from mars2d.addons import Estimate
from mars2d.geometry import wrap
from mars2d.geometry.dead_reckoning import covariances
from mars2d.sensors import Odometry

CORNERS = [(8.0, 0.0), (8.0, 5.0), (0.0, 5.0), (0.0, 0.0)]  # m


def go_home(robot):
    for goal_x, goal_y in CORNERS:
        x, y, theta = robot.sense.odometry
        while hypot(goal_x - x, goal_y - y) > 0.05:
            bearing = wrap(atan2(goal_y - y, goal_x - x) - theta)
            yield 0.5 * max(cos(bearing), 0.0), 2 * bearing
            x, y, theta = robot.sense.odometry


def scenario(drift: float = 0.004, robots: int = 51):
    wheels, odometry = Unicycle(wheel_semiaxis=0.1), Odometry(drift=drift, origin="world")
    runner = Robot(diameter=0.002, drive=wheels, sensors=[odometry], controller=go_home)
    colors, last = ["#7cc4ee"] * (robots - 1) + ["#0072b2"], robots - 1
    return Scenario(
        title="Dead reckoning",
        robots=[runner.replace(sees="sensors").at(0, (k - last) * 0.002) for k in range(robots)],
        workspace=[(-2, -2), (-2, 7), (10, 7), (10, -2)],
        on_exit="ignore",
        physics="ideal",
        stop_time=65.0,
        addons=[Estimate(robot=f"robot{last}")],
        animation=Animation(playback_speed=4, show_real_shape=False, base_colors=colors),
    )


def checks(record):
    robot, belief = record.scenario.robots[-1], record.sensors["odometry"]  # (T, n, 3)
    count, axle, drift = belief.shape[1], robot.drive.wheel_semiaxis, robot.sensors[0].drift
    error, way = record.pose.swapaxes(1, 2) - belief, belief[140, -1, 0]  # straight on for 14 s
    across, off = drift * sqrt(way**3 / 6) / axle, sqrt(np.mean(error[140, :, 1] ** 2))
    yield Prediction("off across a straight way", across, off, 3 * across / sqrt(2 * count), "m")
    inverse = np.linalg.inv(covariances(belief[:, -1], axle, drift)[-1])
    mean = np.mean([e @ inverse @ e for e in error[-1]])
    yield Prediction("mean of e^T P^-1 e at the end", 3, mean, 3 * sqrt(6 / count))
