"""Shove and spin: a blow beside the centre of mass turns what it meets.

How much? A smooth ball (m, v) with restitution e meets a body (M, I) at a lever b. By Newton's and
Poisson's laws the blow is J = (1 + e) v / (1 / m + 1 / M + b^2 / I): a box leaves with the speed
J / M and the spin J b / I, a braked robot turns by (J b)^2 / (2 I T) until its torque T stops it.
Rough discs that graze at an angle a from their line of centres spin by friction: with J cos(a) goes
a tangential blow of mu J cos(a), but at most m v sin(a) / 6, which ends the slip of the rims
(I = m r^2 / 2). Each disc spins with 2 / (m r) of it. Measured: how all have moved at the end.
"""

from math import asin, cos, sin

import numpy as np

from mars2d import Animation, Robot, Scenario, Unicycle
from mars2d.prediction import Prediction
from mars2d.props import Ball, Box, Puck
from mars2d.shapes import Polygon

SQUARE = Polygon([(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)])


def scenario(v: float = 0.8, e: float = 0.8, mu: float = 0.1, lever: float = 0.15):
    ball = Ball(velocity=(v, 0), color="#444444")
    box = Box(mass=3, restitution=e, ground_friction=0, color="#56b4e9")
    disc = Puck(diameter=0.4, restitution=e**0.5, friction=mu**0.5, ground_friction=0)
    brake = Unicycle(max_force=2, max_torque=0.2)
    return Scenario(
        title="Shove and spin",
        robots=[Robot(name="braked", mass=3, drive=brake, shape=SQUARE, restitution=e)],
        props=[box.at(0, 2), box.at(0, 1), disc.at(0, -1)]  # what is hit, and what hits it
        + [ball.at(-1, 2), ball.at(-1, 1 - lever), disc.at(-1, -1.2).replace(velocity=(v, 0))]
        + [ball.at(-1, -lever)],  # this hits the robot
        workspace=[(-1.5, -2), (-1.5, 2.5), (2.5, 2.5), (2.5, -2)],
        sampling_time=0.02,
        stop_time=5.0,
        animation=Animation(playback_speed=0.4),
    )


def blow(ball, body, e, b=0.0):
    """Return J [N s]: ball meets body with restitution e at the lever b [m]."""
    mass, inertia = body.inertia
    return (1 + e) * ball.velocity[0] / (1 / ball.inertia.mass + 1 / mass + b**2 / inertia)


def checks(record):
    robot, (near, far, disc, *balls) = record.scenario.robots[0], record.scenario.props
    speed, _, spin = np.diff(record.prop_pose[-2:], axis=0)[0] / record.scenario.sampling_time
    e, b = robot.restitution, far.pose[1] - balls[1].pose[1]
    j = [blow(balls[0], near, e), blow(balls[1], far, e, b), blow(balls[3], robot, e, b)]
    yield Prediction("box hit in the middle: speed", j[0] / near.mass, speed[0], 1e-6, "m/s")
    yield Prediction(f"box hit {b:g} m beside: speed", j[1] / far.mass, speed[1], 1e-6, "m/s")
    yield Prediction(f"box hit {b:g} m beside: spin", j[1] * b / far.inertia[1], spin[1], 1e-6, "1/s")
    turn = (j[2] * b) ** 2 / (2 * robot.inertia.moment * robot.drive.max_torque)
    yield Prediction("braked robot: angle turned", turn, record.pose[-1, 2, 0], 0.01 * turn, "rad")
    a = asin((disc.pose[1] - balls[2].pose[1]) / disc.diameter)
    along = disc.friction**2 * blow(balls[2], disc, disc.restitution**2) * cos(a)
    ends_slip = disc.inertia.mass * balls[2].velocity[0] * sin(a) / 6
    graze = 4 * min(along, ends_slip) / (disc.inertia.mass * disc.diameter)
    for which, k in (("grazed", 2), ("grazing", 5)):
        yield Prediction(f"{which} disc: spin", graze, spin[k], 2e-3 * graze, "1/s")
