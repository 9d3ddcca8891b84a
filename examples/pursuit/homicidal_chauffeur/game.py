"""Homicidal chauffeur: a fast car that can't turn tightly, and a slow pedestrian that can.

Question: from which width on does the car win from any start?
Setting: distributed, partial information: each knows its own pose and that of the other. The car
goes at 1 m/s always and steers; the pedestrian asks for a velocity. A touch is a capture: their
middles are `reach` apart, drawn about the limit if it is 0.
Play: by mars2d run homicidal_chauffeur --human pedestrian
Source: R. Isaacs, Differential Games, 1965; A. W. Merz, The Homicidal Chauffeur, Stanford, 1971.
Prediction: for a radius R, l = reach / R and g < 1, the ratio of the speeds, the car wins from
everywhere in the endless plane if and only if l > sqrt(1 - g^2) + g asin(g) - 1. That is how far,
in radii, the pedestrian gets clear that steps aside when the car is g R ahead of it.
"""

from math import cos, pi, sin

import numpy as np
import theory

from mars2d import Animation, Dubins, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

SPEED, RADIUS, PERSON = 1.0, 2.0, 0.2  # m/s and m, of the car; m, the pedestrian's diameter


def scenario(
    ratio: float = 0.5,
    reach: float = 0.0,  # m, 0: drawn from 0.85 to 1.15 of the limit
    car: str = "cars/swerve.py",
    pedestrian: str = "pedestrians/matador.py",
    accel: float = 0.0,  # m/s^2, what tyres and feet hold, 0: any
    seed: int = 0,
):
    def barrier(scene, frame):  # where the pedestrian is lost, in the frame of the car
        (x, y, theta), tau = frame.pose[:, 0], np.linspace(0, pi / 2, 200)
        s, left = np.arccos(ratio) + tau, reach / RADIUS - ratio * tau
        across, ahead = left * np.sin(s) + 1 - np.cos(tau), left * np.cos(s) + np.sin(tau)
        across = across[: np.argmax(np.append(across, -1) < 0)]
        for side in (1, -1):
            at = RADIUS * (ahead[: len(across)] + side * 1j * across) * np.exp(1j * theta)
            scene.line(np.transpose([x + at.real, y + at.imag]), stroke="#7b3294", width=3)
            middle = x - side * RADIUS * sin(theta), y + side * RADIUS * cos(theta)
            scene.circle(middle, RADIUS, stroke="#7b329480")
        path = np.array([*frame.path, frame.pose])
        for robot, place in zip(
            robots, theory.best(path, ratio, RADIUS, 0.02 * SPEED), strict=False
        ):
            scene.circle(place, robot.radius, stroke="#7b3294")

    rng = np.random.default_rng(seed)
    way, heading = rng.uniform(0, 2 * pi, 2)
    reach = reach or max(least(min(ratio, 1)) * rng.uniform(0.85, 1.15), 0.6 * PERSON)
    hold = {"force_limited": accel > 0, "max_force": accel or 1.0, "max_torque": 100.0}
    drive = Dubins(max_linear_speed=SPEED, max_angular_speed=SPEED / RADIUS, **hold)
    red = Robot(name="car", sees="partial", diameter=2 * reach - PERSON, drive=drive)
    feet = Holonomic(max_linear_speed=ratio * SPEED, **hold)
    blue = red.replace(name="pedestrian", diameter=PERSON, drive=feet).at(0, 0)
    red = red.replace(controller=load_law(car)).at(5 * cos(way), 5 * sin(way), heading)
    robots = [red, blue.replace(controller=load_law(pedestrian))]
    game = Game({"car": ["car"], "pedestrian": ["pedestrian"]})
    return Scenario(
        title="Homicidal chauffeur", robots=robots,
        workspace=[(-12, -12), (12, -12), (12, 12), (-12, 12)], on_exit="ignore",
        sampling_time=0.02, stop_time=40.0,
        addons=[game, Theory(barrier)] if ratio < 1 else [game],
        animation=Animation(base_colors=("red", "blue"), playback_speed=5),
    )  # fmt: skip


least, checks = theory.least, theory.checks
