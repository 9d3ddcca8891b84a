"""Two cars: each drives at a constant speed with bounded turns; the faster one hunts.

Question: is it enough to be quicker?
Setting: distributed, partial information: each knows its own pose and that of the other, and
steers. A touch is a capture. The evader's radius is drawn from 0.4 to 1.2 m if it is 0.
Play: by mars2d run two_cars --human evader
Source: E. J. Cockayne, Plane pursuit with curvature constraints, SIAM Journal on Applied
Mathematics 15, 1967: with points in the endless plane the pursuer can capture from every start if
and only if it is quicker, v > w, and can bend its way as strongly, v^2 / R >= w^2 / r, for the
least turning radii R and r. R. Isaacs, Differential Games, 1965, gives them a width.
Prediction: from one behind the other at the distance d, with both steering as hard as they can to
the same side, the nearest comes out of two circles; that is the way past if the evader bends more.
"""

from math import cos, pi, sin

import numpy as np
import theory

from mars2d import Animation, Dubins, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

SPEED, RADIUS, RATIO = 1.0, 2.0, 0.7  # m/s and m, of the pursuer; the evader's share of its speed


def scenario(
    radius: float = 0.0,  # m, of the evader, 0: drawn
    pursuer: str = "pursuers/lead.py",
    evader: str = "evaders/jink.py",
    accel: float = 0.0,  # m/s^2, what tyres hold, 0: any
    seed: int = 0,
):
    def ways(scene, frame):  # the tightest that each can go for the next two seconds
        for robot, pose in zip(frame.scenario.robots, frame.pose.T, strict=True):
            for side in (1, -1):
                at = theory.circles(pose, robot.drive, np.linspace(0, 2, 40), side)
                scene.line(np.transpose([at.real, at.imag]), stroke="#7b3294", width=2)

    rng = np.random.default_rng(seed)
    way, heading, other = rng.uniform(0, 2 * pi, 3)
    radius = radius or rng.uniform(0.4, 1.2)
    hold = {"force_limited": accel > 0, "max_force": accel or 1.0, "max_torque": 100.0}
    quick = Dubins(max_linear_speed=SPEED, max_angular_speed=SPEED / RADIUS, **hold)
    slow = Dubins(max_linear_speed=RATIO * SPEED, max_angular_speed=RATIO * SPEED / radius, **hold)
    red = Robot(name="red", sees="partial", diameter=0.2, drive=quick, controller=load_law(pursuer))
    blue = red.replace(name="blue", drive=slow, controller=load_law(evader)).at(0, 0, other)
    return Scenario(
        title="Two cars", robots=[red.at(6 * cos(way), 6 * sin(way), heading), blue],
        workspace=[(-15, -15), (15, -15), (15, 15), (-15, 15)], on_exit="ignore",
        sampling_time=0.02, stop_time=40.0,
        addons=[Game({"pursuer": ["red"], "evader": ["blue"]}), Theory(ways)],
        animation=Animation(base_colors=("red", "blue"), playback_speed=5),
    )  # fmt: skip


checks = theory.checks
