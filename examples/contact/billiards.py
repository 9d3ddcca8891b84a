"""Billiards: balls collide head-on or obliquely, or are shot by a robot.

Question: a ball with the speed v meets an equal one at rest. How quickly do both go on, and where
to? And a ball that a robot shoots?
Prediction: the momentum stays (Wallis, Wren, Huygens, 1668), and along the line of their centres
balls part with e times the speed at which they met (Newton's law of restitution). So straight on,
the first keeps (1 - e) v / 2 and the other gets (1 + e) v / 2. Off the middle by b, smooth balls
of diameter d have that line at the angle a, sin a = b / d: for e = 1 the other goes off along it
with v cos a, and the first at a right angle to it with v sin a. A robot of mass M that drives at
the speed u gives a ball of mass m the speed (1 + e) u M / (M + m).
Measured: the balls' velocities at the end, and the momentum of all that met a ball.
"""

from math import asin, atan2, cos, degrees, hypot, sin

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle
from mars2d.bodies import Ball

RESTITUTIONS, LANES = (0.0, 0.5, 1.0), (2.2, 1.6, 1.0)  # m
DRIVE = 0.3  # m/s


def scenario(speed: float = 0.5, offset: float = 0.1):
    rest = Ball(diameter=0.2, mass=1.0, color="#d55e00")
    first = rest.replace(velocity=(speed, 0, 0), color="#e69f00")
    balls = [first.at(-0.8, -1.2), rest.at(0, -1.2 + offset), rest.at(0, 0.3)]
    for e, y in zip(RESTITUTIONS, LANES, strict=True):
        balls += [first.at(-0.8, y).replace(restitution=e), rest.at(0, y)]
    shooter = Robot(mass=2.0, restitution=1.0, drive=Unicycle(max_force=0.2))  # just hits
    return Scenario(
        title="Billiards",
        robots=[shooter.at(-0.45, 0.3)],
        props=balls,
        workspace=[(-1.2, -2.7), (-1.2, 2.6), (3.2, 2.6), (3.2, -2.7)],
        sampling_time=0.05,
        stop_time=3.0 / speed,
        max_overlap=1e-4,
        animation=Animation(playback_speed=0.5, forces=True),
    )


def control(world):
    return np.outer([DRIVE, 0.0], np.ones(len(world.robots)))


def checks(record):
    balls, robot = record.scenario.props, record.scenario.robots[0]
    m, d, speed = balls[0].mass, balls[0].diameter, balls[0].velocity[0]
    offset = balls[1].pose[1] - balls[0].pose[1]
    alike = all((b.mass, b.friction, b.ground_friction) == (m, 0, 0) for b in balls)
    if not alike or record.contacts["began"].sum() != 5 or offset > 0.99 * d:  # it only grazes
        yield Prediction.silent("speeds", "for smooth, equal balls that glide, and meet just once")
        return
    vx, vy = np.diff(record.prop_pose[-2:, :2], axis=0)[0] / record.scenario.sampling_time
    for k in (3, 5, 7):
        e = record.scenario.restitution_between(k + 1, k + 2)  # as bodies: after the robot
        yield Prediction(f"e = {e:g}: first", (1 - e) * speed / 2, vx[k], 1e-6, "m/s")
        yield Prediction(f"e = {e:g}: other", (1 + e) * speed / 2, vx[k + 1], 1e-6, "m/s")
    a, e = asin(offset / d), record.scenario.restitution_between(1, 2)
    (along, other), across = np.array([1 - e, 1 + e]) / 2 * speed * cos(a), speed * sin(a)
    yield Prediction("oblique: first", hypot(along, across), hypot(vx[0], vy[0]), 1e-3, "m/s")
    yield Prediction("oblique: other", other, hypot(vx[1], vy[1]), 1e-3, "m/s")
    yield Prediction("oblique: angle", degrees(a), degrees(atan2(vy[1], vx[1])), 0.1, "degrees")
    yield Prediction("momentum", 4 * m * speed, m * (vx.sum() - vx[2]), 1e-9, "kg m/s")
    shot = (1 + record.scenario.restitution_between(0, 3)) * DRIVE / (1 + m / robot.mass)
    yield Prediction("shot by the robot", shot, vx[2], 0.004, "m/s")
