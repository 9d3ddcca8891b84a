"""Stick-slip: a body drawn by a spring moves in jerks if its static friction is higher.

Question: a robot draws a box of mass m by a spring of stiffness k, at the speed v. The floor holds
it at rest with up to mus m g, and while it slides with mu m g (Coulomb, 1785). Does it follow
smoothly? If not, how long does a jerk take, how fast is it, how hard does the spring draw?
Prediction: the box rests until the spring draws with mus m g. Then it swings, with w = sqrt(k / m),
about the stretch at which it draws with mu m g: from d = (mus - mu) m g / k above that to d below,
where it rests again until the spring is 2 d longer (H. Blok, SAE Journal 46, 54, 1940). Period:
2 d / v + (2 / w) (pi - atan(d w / v)); top speed: v + sqrt(v^2 + (w d)^2); largest force:
mu m g + k sqrt(d^2 + (v / w)^2). In the last lane a damper ends the swing: the box follows at v.
"""

from math import atan, hypot, pi, sqrt

import numpy as np

from mars2d import Prediction, Robot, Scenario, Unicycle
from mars2d.bodies import Box, Spring
from mars2d.core.materials import GRAVITY

LANES, STATIC, DAMPED = (1.5, 0.5, -0.5, -1.5), (1.5, 2.0, 2.5, 1.0), (0, 0, 0, 1)  # m, mus / mu


def scenario(mu: float = 0.2, speed: float = 0.1, stiffness: float = 25.0, damping: float = 12.0):
    tug = Robot(drive=Unicycle(max_force=90.0, max_linear_speed=speed), color="#0072b2")
    box = Box(length=0.4, width=0.4, mass=1.0, ground_friction=mu, color="#e69f00")
    boxes = [box.replace(name=f"mus = {k:g} mu", static_ground_friction=k * mu) for k in STATIC]
    springs = [Spring(a="", b="", stiffness=stiffness, damping=c * damping) for c in DAMPED]
    return Scenario(
        title="Stick-slip",
        robots=[tug.at(-2, y) for y in LANES],
        props=[box.at(-3, y) for box, y in zip(boxes, LANES, strict=True)],
        joints=[s.replace(a=f"robot{i}", b=boxes[i].name) for i, s in enumerate(springs)],
        workspace=[(-3.5, -2), (-3.5, 2), (1.5, 2), (1.5, -2)],
        sampling_time=0.02,
        stop_time=25.0,
    )


def control(world):
    return [[robot.drive.max_linear_speed for robot in world.robots], [0.0] * len(LANES)]


def checks(record):
    v, dt = record.scenario.robots[0].drive.max_linear_speed, record.scenario.sampling_time
    for i, box in enumerate(record.scenario.props):
        spring, x = record.scenario.joints[i], record.prop_pose[:, 0, i]
        k, weight = spring.stiffness, box.mass * GRAVITY
        w, d = sqrt(k / box.mass), (box.resting_friction - box.ground_friction) * weight / k
        speed, most = np.diff(x) / dt, k * (record.pose[:, 0, i] - x - 1.0).max()
        starts = record.time[1:-1][(speed[:-1] < v) & (speed[1:] >= v)]
        if spring.damping:
            yield Prediction(f"{box.name}, damped: speed", v, speed[-1], 0.01 * v, "m/s")
            continue
        force = box.ground_friction * weight + k * hypot(d, v / w)
        period, top = 2 * d / v + 2 / w * (pi - atan(d * w / v)), v + hypot(v, w * d)
        if len(starts) < 2:
            yield Prediction.silent(f"{box.name}: period", "it has jerked less than twice")
            continue
        mean = np.diff(starts).mean()
        yield Prediction(f"{box.name}: period", period, mean, 0.02 * period, "s")
        yield Prediction(f"{box.name}: top speed", top, speed.max(), 0.02 * top, "m/s")
        yield Prediction(f"{box.name}: largest force", force, most, 0.02 * force, "N")
