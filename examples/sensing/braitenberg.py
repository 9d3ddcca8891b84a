"""Braitenberg's vehicles: two eyes, two wheels, and what looks like fear, aggression and love.

Setting: distributed, sensors only: two eyes, turned to the left and right. Each feels the light of
the lamps before it, the sum of cos(bearing) / (range^2 + H^2), H being their height, and turns a
wheel at base + gain light: that on its own side, or crossed over, on the other one.
Prediction: with gain > 0 there is fear, which turns away, and, crossed, aggression, which drives
right over a lamp; with gain < 0 love, which rests where base + gain light = 0, and, crossed, the
explorer, which evades lamps. Source: V. Braitenberg, Vehicles (1984), vehicles 2 and 3.
"""

from functools import partial
from math import atan2, cos, pi, sin, sqrt

import numpy as np

from mars2d import Differential, InputError, Prediction, Robot, Scenario
from mars2d.addons import Beacon
from mars2d.sensors import Beacon as Eye

LAMP, H, FRONT, TURN, WHEEL = 2.0, 0.2, 0.1, pi / 4, 0.05  # m, m, m, rad, m


def light(eye):
    return sum(max(cos(lamp.bearing), 0.0) / (lamp.range**2 + H**2) for lamp in eye.values())


def drive(base, gain, crossed, robot):
    eyes = [robot.sense.left, robot.sense.right]
    return [base + gain * light(eye) for eye in (reversed(eyes) if crossed else eyes)]  # rad/s


def scenario(base: float = 5.0, gain: float = 8.0):
    if not 0 < base < gain * cos(TURN) / H**2:
        raise InputError(f"base = {base}, gain = {gain}: expected 0 < base < gain cos(TURN) / H^2")
    eye, robots = partial(Eye, through_walls=True, noise=0.02), []
    eyes = [eye(name="left", mount=(FRONT, 0, TURN)), eye(name="right", mount=(FRONT, 0, -TURN))]
    vehicle = Robot(sensors=eyes, sees="sensors", drive=Differential(wheel_radius=WHEEL))
    for name, wires, start in (
        ("fear", (base / 3, 5 * gain, False), (-4.3, 0.5, -0.1)),
        ("aggression", (base / 3, 5 * gain, True), (0.3, -3.5, 2.0)),
        ("love", (base, -gain, False), (4.8, 3.0, 3.3)),
        ("explorer", (base, -gain, True), (-1.2, 4.5, -1.5)),
    ):
        robots.append(vehicle.replace(name=name, pose=start, controller=partial(drive, *wires)))
    lamps = [Beacon((-LAMP, 0), name="west"), Beacon((LAMP, 0), name="east")]
    title = "Fear (blue), aggression (orange), love (green), explorer (pink)"
    return Scenario(title=title, robots=robots, on_exit="ignore", stop_time=25.0, addons=lamps)


def checks(record):
    base, gain, _ = record.scenario.robots[2].controller.args  # of love
    rest = FRONT + sqrt(-gain * cos(TURN) / base - H**2)
    away = np.hypot(abs(record.pose[:, 0]) - LAMP, record.pose[:, 1])  # (T, 4), of the nearest lamp
    pace = np.hypot(*(record.pose[-1, :2] - record.pose[-2, :2])) / record.scenario.sampling_time
    yield Prediction("aggression: nearest to a lamp", 0, away[:, 1].min(), 0.05, "m")
    x, y, theta = record.pose[-1]
    for k, name, predicted in ((0, "fear", WHEEL * base / 3), (3, "explorer", WHEEL * base)):
        ahead = max(cos(atan2(-y[k], lamp - x[k]) - theta[k]) for lamp in (-LAMP, LAMP))
        if ahead < -sin(TURN):  # no eye feels any lamp
            yield Prediction(f"{name}: pace in the dark", predicted, pace[k], 0.01, "m/s")
        else:
            yield Prediction.silent(f"{name}: pace in the dark", "it still sees a lamp")
    if pace[2] < 0.1 * WHEEL * base:
        yield Prediction.within("love: rests before a lamp at", rest, away[-1, 2], 5, "m")
    else:
        yield Prediction.silent("love: rests before a lamp at", "it is still on its way")
