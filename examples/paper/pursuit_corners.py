"""Pursuit round four corners: a pursuer that heads straight for a faster evader ends up in a cycle.

Setting: distributed, partial information: each knows its own pose and where the other is.
Law: the pursuer, a unicycle, turns to the evader and drives at mu times its speed. The evader, at
one of four points near the corners, goes on to a neighbouring one: that farther from the pursuer.
Source: Casini and Garulli, 2016, 5.1: it escapes at mu = 0.9 for 500 s. All other numbers are ours.
Prediction: with the distance r and phi its angle to the way, r (mu + cos phi) grows by 1 - mu^2 a
metre, and r = c tan(phi/2)^mu / sin phi (Bouguer, 1732). Points turn phi from almost 0 to pi/2, so
r becomes c = (1 - mu^2) SIDE there; least it is at cos phi = mu: a diameter or less is a capture.
"""

from functools import partial
from math import atan2, dist, pi, sqrt

import numpy as np

from mars2d import Animation, Holonomic, Prediction, Robot, Scenario
from mars2d.addons import Game, Theory
from mars2d.geometry import wrap

SPEED, SIDE = 0.2, 9.0  # m/s, of the evader; m, between its points
POINTS = SIDE / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])


def evade(robot, k=0):
    while True:
        if dist(robot.position, POINTS[k]) < 1e-9:
            hunter = robot.neighbours[0].position
            k = max((k + 1) % 4, (k - 1) % 4, key=lambda j: dist(POINTS[j], hunter))
        yield (POINTS[k] - robot.position) / robot.sampling_time  # its drive limits this to SPEED


def pursue(mu, robot):
    x, y = robot.neighbours[0].position - robot.position
    return mu * SPEED, wrap(atan2(y, x) - robot.pose[2]) / robot.sampling_time


def scenario(mu: float = 0.9):
    def cycle(scene, _):  # one side in complex numbers, turned four times
        phi = np.linspace(pi / 2, 2 ** (mu / (mu - 1)), 200)
        r = (1 - mu**2) * SIDE * np.tan(phi / 2) ** mu / np.sin(phi)
        way = r * (mu + np.cos(phi)) / (1 - mu**2) - (mu + 0.5) * SIDE
        path = np.outer([1, 1j, -1, -1j], way - r * np.exp(-1j * phi) - 0.5j * SIDE).ravel()
        scene.polygon(np.array([path.real, path.imag]).T, stroke="#7b329480", width=4)

    red = Robot(name="red", diameter=0.55, sees="positions", controller=partial(pursue, mu))
    blue = red.replace(name="blue", drive=Holonomic(max_linear_speed=SPEED), controller=evade)
    robots, title = [red.at(-2, 2), blue.at(*POINTS[0])], "Pursuit round four corners"
    addons = [Game({"pursuer": ["red"], "evader": ["blue"]}), Theory(cycle)][: 1 + (mu < 1)]
    look = Animation(base_colors=("red", "blue"), playback_speed=20)
    return Scenario(title=title, robots=robots, stop_time=500.0, addons=addons, animation=look)


def checks(record):
    red, lap = record.scenario.robots[0], 4 * SIDE / SPEED
    (mu,), near, late = red.controller.args, red.diameter, record.time > record.time[-1] - lap
    if 0.87 < mu < 1 and (record.scenario.stop_time > 2 * lap or len(record.contacts)):
        least = sqrt(1 - mu**2) * ((1 - mu) / (1 + mu)) ** (mu / 2) * SIDE
        r = np.hypot(*np.diff(record.pose[late, :2])[..., 0].T)
        yield Prediction("least distance in the last round", max(least, near), r.min(), 0.04, "m")
