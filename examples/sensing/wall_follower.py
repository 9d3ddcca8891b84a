"""Wall follower: a robot keeps its distance from the wall on its left by sonar, all around a room.

Setting: distributed, sensors only: a ring of eight sonars, each of which hears the nearest surface
in a cone. Law (PD): omega = k e + c e', with e the distance on the left less the one to keep, and
e' its change. Before a corner it turns right on the spot; where the wall ends it bends left.
Question: how smoothly does it come to its distance?
Prediction: along a straight wall e'' = -v omega, for small angles: an oscillation of the frequency
w = sqrt(v k) with the damping z = c v / (2 w). From e = OFF it goes through
e = OFF exp(-z w t) (cos a + z / s sin a), where s = sqrt(1 - z^2) and a = w s t. With z < 1 it so
comes too near by OFF exp(-pi z / s). Source: K. Ogata, Modern Control Engineering (2010), sec. 5-3.
"""

from functools import partial

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario
from mars2d.sensors import SonarRing

SPEED, PACE, OFF, TOP = 0.4, 0.6, 0.3, 3.0  # v [m/s], w [rad/s], OFF [m], y of the first wall [m]
AHEAD, LEFT, STEP = 4, 6, 0.05  # two sonars, counted from behind; sampling time [s]


def follow(robot, distance, damping):
    last = OFF
    while True:
        ahead, left = robot.sense.sonar_ring[[AHEAD, LEFT]]
        error = min(left - distance, distance)
        if ahead < 1.4 * distance:  # a corner of the room,
            yield 0.0, -1.0
        elif error == distance:  # or the end of a wall,
            yield SPEED, SPEED / distance
        else:  # or a wall
            yield SPEED, PACE * (PACE * error + 2 * damping * (error - last) / STEP) / SPEED
        last = error


def scenario(distance: float = 0.5, damping: float = 0.3, noise: float = 0.001):
    sonars = SonarRing(sonars=8, cone=0.7, range=2.0, noise=noise)
    robot = Robot(sensors=[sonars], controller=partial(follow, distance=distance, damping=damping))
    return Scenario(
        title="Wall follower",
        robots=[robot.replace(sees="sensors").at(-4.4, TOP - distance - OFF)],
        workspace=[(-5, -3), (-5, TOP), (5, TOP), (5, -0.5), (1, -0.5), (1, -3)],
        on_exit="wall",
        sampling_time=STEP,
        stop_time=90.0,
        animation=Animation(playback_speed=3),
    )


def checks(record):
    distance, z = record.scenario.robots[0].controller.keywords.values()
    t, s = record.time[:400], np.emath.sqrt(1 - z**2 or 1e-9)  # its first 20 s, along one wall
    wave = np.cos(PACE * s * t) + z / s * np.sin(PACE * s * t)  # s is imaginary where z > 1
    curve = OFF * np.exp(-z * PACE * t) * wave.real
    error, nearest = TOP - distance - record.pose[:400, 1, 0], distance + min(curve)
    name = "least distance to the first wall"
    heading = np.abs(np.gradient(curve, t)).max() / SPEED
    if heading > record.scenario.robots[0].sensors[0].cone / 2:
        why = "it is to turn so far that its sonar does not hear the nearest point of the wall"
        yield Prediction.silent(name, why)
    else:
        yield Prediction(name, nearest, distance + min(error), 0.02, "m")
        off = np.abs(error - curve).max()
        yield Prediction("farthest from the curve of theory", 0, off, 0.03, "m")
    yield Prediction("collisions", 0, record.collisions, 0)
