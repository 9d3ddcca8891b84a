"""Shove and spin: a blow off the centre of mass spins the body.

Question: a ball hits a box off its centre. How fast does the box leave, how fast does it turn?
Prediction: a smooth ball (m, v) with restitution e meets a body (M, I) at the lever b with the blow
J = (1 + e) v / (1 / m + 1 / M + b^2 / I) (Newton, Poisson). All of it gives the box its speed
J / M, wherever it hits, and its moment J b gives the spin J b / I. A braked robot turns by
(J b)^2 / (2 I T), until its torque T has stopped it. One rough disc grazes another at an angle a
from the line of centres: with J cos(a) goes a tangential blow K = mu J cos(a) (Coulomb), or
m v sin(a) / 6 if less: that ends the slip. It spins both discs with 2 K / (m r), as I = m r^2 / 2.
Measured: how all have moved at the end.
"""

from math import asin, cos, sin

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle
from mars2d.bodies import Ball, Box, Puck
from mars2d.geometry import Polygon

SQUARE = Polygon([(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)])


def scenario(v: float = 0.8, e: float = 0.8, mu: float = 0.1, lever: float = 0.15):
    ball = Ball(velocity=(v, 0), color="#444444")
    box = Box(mass=3, restitution=e, ground_friction=0, color="#56b4e9")
    disc = Puck(diameter=0.4, restitution=e**0.5, friction=mu**0.5, ground_friction=0)
    other = disc.at(-1, -1.2).replace(velocity=(v, 0))
    targets = box.at(0, 2), box.at(0, 1), disc.at(0, -1)
    brake = Unicycle(max_force=2, max_torque=0.1)
    return Scenario(
        title="Shove and spin",
        robots=[Robot(name="braked", mass=3, drive=brake, shape=SQUARE, restitution=e)],
        props=[*targets, ball.at(-1, 2), ball.at(-1, 1 - lever), other, ball.at(-1, -lever)],
        workspace=[(-1.5, -2.8), (-1.5, 2.5), (2.5, 2.5), (2.5, -2.8)],
        sampling_time=0.01,
        stop_time=5.0,
        animation=Animation(playback_speed=0.4, forces=True),
    )


def blow(ball, body, e, b=0.0):
    mass, inertia = body.inertia
    return (1 + e) * ball.velocity[0] / (1 / ball.inertia.mass + 1 / mass + b**2 / inertia)


def checks(record):
    robot, (box, _, disc, _, ball, other, last) = record.scenario.robots[0], record.scenario.props
    speed, _, spin = np.diff(record.prop_pose[-2:], axis=0)[0] / record.scenario.sampling_time
    b, e = -last.pose[1], record.scenario.restitution_between
    blows = [int((record.contacts["b"] == k).sum()) for k in (4, 5, 6, 7)]
    if any(prop.ground_friction for prop in (box, disc)) or blows != [1] * 4 or abs(b) >= 0.2:
        why = "each ball has to hit once, on a face of a body that the floor does not hold"
        yield Prediction.silent("speeds and spins", why)
        return
    for k, lever in enumerate([0, b]):
        name, j = ("box hit in the middle", "box hit beside it")[k], blow(ball, box, e(1, 5), lever)
        yield Prediction(f"{name}: speed", j / box.mass, speed[k], 1e-6, "m/s")
        yield Prediction(f"{name}: spin", j * lever / box.inertia.moment, spin[k], 1e-6, "rad/s")
    moment = blow(last, robot, e(0, 7), b) * b
    turn = moment * abs(moment) / (2 * robot.inertia.moment * robot.drive.max_torque)
    if record.pose[-1, 2, 0] == record.pose[-2, 2, 0]:  # it has stopped
        yield Prediction("braked robot: turn", turn, record.pose[-1, 2, 0], 0.02 * abs(turn), "rad")
    m, d, a = disc.inertia.mass, disc.diameter, asin((disc.pose[1] - other.pose[1]) / disc.diameter)
    most = record.scenario.friction_between(3, 6) * blow(other, disc, e(3, 6)) * cos(a)
    graze = 4 * min(most, m * other.velocity[0] * sin(a) / 6) / (m * d)
    yield Prediction("grazed disc: spin", graze, spin[2], 2e-3 * graze + 1e-9, "rad/s")
