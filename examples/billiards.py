"""Billiards: what balls do when they meet straight on, obliquely, and when a robot shoots.

Question: a ball with the speed v meets an equal one at rest. How quickly, and where to, do both go
on? And a ball that a robot shoots?
Prediction: the momentum stays (Wallis, Wren, Huygens, 1668), and along the line of the centres
balls part at e times the speed at which they met (Newton's law of restitution). So straight on the
first keeps (1 - e) v / 2 and the other gets (1 + e) v / 2. Hit off its middle by b, a smooth ball
of diameter d goes off at the angle asin(b / d); for e = 1 the first turns by 90 degrees less that.
A robot of mass M gives a ball of mass m the speed (1 + e) v M / (M + m).
Measured: the balls' velocities at the end, and the momentum of all balls that met.
"""

from math import asin, atan2, degrees, hypot

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario
from mars2d.props import Ball

RESTITUTIONS, LANES = (0.0, 0.5, 1.0), (2.2, 1.6, 1.0)  # m


def scenario(speed: float = 0.5, offset: float = 0.1):
    ball = Ball(diameter=0.2, mass=1.0, color="#d55e00")
    cue = ball.replace(velocity=(speed, 0, 0), color="#e69f00")
    balls = []
    for e, y in zip(RESTITUTIONS, LANES, strict=True):
        balls += [cue.at(-0.8, y).replace(restitution=e), ball.at(0, y)]
    oblique = [cue.at(-0.8, -1.2), ball.at(0, -1.2 + offset)]
    return Scenario(
        title="Billiards",
        robots=[Robot(pose=(-0.8, 0.4, 0), mass=2.0, restitution=1.0, color="#0072b2")],
        props=[*balls, *oblique, ball.at(0, 0.4)],
        workspace=[(-1.2, -2.7), (-1.2, 2.6), (3.2, 2.6), (3.2, -2.7)],
        sampling_time=0.05,
        stop_time=6.0,
        animation=Animation(playback_speed=0.5, forces=True),
    )


def control(world):
    return np.array([[0.3], [0.0]])


def checks(record):
    balls, robot = record.scenario.props, record.scenario.robots[0]
    speed, diameter = balls[0].velocity[0], balls[0].diameter
    vx, vy = np.diff(record.prop_pose[-2:, :2], axis=0)[0] / record.scenario.sampling_time
    for k, e in enumerate(RESTITUTIONS):
        yield Prediction(f"e = {e:g}: first", (1 - e) * speed / 2, vx[2 * k], 1e-6, "m/s")
        yield Prediction(f"e = {e:g}: other", (1 + e) * speed / 2, vx[2 * k + 1], 1e-6, "m/s")
    angle = degrees(asin((balls[7].pose[1] - balls[6].pose[1]) / diameter))
    yield Prediction("oblique: other", angle, degrees(atan2(vy[7], vx[7])), 0.1, "deg")
    yield Prediction("oblique: first", angle - 90, degrees(atan2(vy[6], vx[6])), 0.1, "deg")
    yield Prediction("momentum along x", 4 * speed, vx[:8].sum(), 1e-9, "kg m/s")
    yield Prediction("momentum along y", 0.0, vy[:8].sum(), 1e-9, "kg m/s")
    shot = 2 * 0.3 * robot.mass / (robot.mass + balls[8].mass)
    yield Prediction("ball shot by the robot", shot, vx[8], 0.02 * shot, "m/s")
