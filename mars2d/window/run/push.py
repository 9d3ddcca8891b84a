"""How strongly hands pull a body; a measured push, a constant force on it for a time."""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import cos, degrees, hypot, radians, sin

from mars2d.core.errors import InputError, shown
from mars2d.core.plane import Point
from mars2d.core.scene import Scene
from mars2d.output.layers.forces import FORCE, in_newtons
from mars2d.output.raster.camera import Camera
from mars2d.record.frame import Frame
from mars2d.record.interventions import Push
from mars2d.scenario.scenario import Scenario
from mars2d.window.panels.readout import holding_force
from mars2d.window.run.marks import HALO, draw_words, world_point

PULL_ACCELERATION = 10.0
"""How strongly a pull accelerates a body, after it has overcome the resistance, m/s^2."""
MAX_PULL_SPEED = 5.0
"""m/s."""
SECONDS = 0.5
"""How long a push lasts that is aimed with the mouse."""
REACH = 0.25
"""How far one pulls for the force of a strong pull, in parts of the workspace."""
NUMBER = r"(\d*\.?\d+)"
TYPED = re.compile(rf"{NUMBER} ?N?(?: ?for {NUMBER} ?s?)?(?: ?at (-?){NUMBER} ?(?:°|deg)?)?")
EXPECTED = "such as 3 N for 0.5 s at 90°"


def pull_of(scenario: Scenario, body: int) -> tuple[float, float]:
    """Return the largest force [N] and speed [m/s] with which the mouse pulls a body.

    They overcome the body's drive or the floor, and cross the workspace in a few seconds.
    """
    xmin, xmax, ymin, ymax = scenario.bounds
    speed = 0.2 * max(xmax - xmin, ymax - ymin)
    if body < len(scenario.robots):
        speed = max(speed, 1.5 * scenario.robots[body].drive.max_linear_speed)
    force = 1.5 * holding_force(scenario, body)
    force += PULL_ACCELERATION * scenario.bodies[body].inertia.mass
    return force, min(speed, MAX_PULL_SPEED)


def stiffness_of(scenario: Scenario, body: int) -> float:
    """Return the newtons for a metre of arrow."""
    xmin, xmax, ymin, ymax = scenario.bounds
    return pull_of(scenario, body)[0] / (REACH * max(xmax - xmin, ymax - ymin))


def draw_pushes(scene: Scene, frame: Frame, pushes: Iterable[Push], camera: Camera) -> None:
    """Draw pushes as arrows from where they act, each with its newtons and seconds."""
    for push in pushes:
        (x, y), newtons = push.force, hypot(*push.force)
        start = world_point(frame.body_pose(push.body), push.grip)
        length = stiffness_of(frame.scenario, push.body)
        tip = start[0] + x / length, start[1] + y / length
        scene.arrow(start, tip, fill=FORCE, width=3.0, stroke=HALO)
        xmin, xmax, ymin, ymax = frame.scenario.bounds  # words of a long arrow stay in sight
        tip = min(max(tip[0], xmin), xmax), min(max(tip[1], ymin), ymax)
        draw_words(scene, camera, tip, f"{in_newtons(newtons)} for {push.duration:g} s")


def pushed(text: str, heading: float) -> tuple[Point, float]:
    """Return the force [N] and the duration [s] that a text says; heading: where it says none.

    >>> pushed("3 N for 2 s", heading=0.0)
    ((3.0, 0.0), 2.0)
    """
    found = TYPED.fullmatch(text.strip())
    if found is None:
        raise InputError(f"{shown(text)}: expected a force, {EXPECTED}")
    newtons, seconds, sign, angle = found.groups()
    way = heading if angle is None else radians(float(sign + angle))
    force = float(newtons) * cos(way), float(newtons) * sin(way)
    return force, float(seconds or SECONDS)


def suggested(frame: Frame, body: int) -> str:
    """Return a push of a body as it is typed: as strong as a strong pull, ahead."""
    force = pull_of(frame.scenario, body)[0]
    return f"{force:.2g} N for {SECONDS:g} s at {round(degrees(frame.body_pose(body)[2])):d}°"
