"""What the marks of a layer mean: arrows of a round length, and signs with a few words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from mars2d.addons.base import Addon
from mars2d.core.plane import Point
from mars2d.core.scene import (
    PALETTE,
    THEORY,
    Arrow,
    Circle,
    Line,
    Polygon,
    Scene,
    Shape,
    faded,
)
from mars2d.core.usercode import called
from mars2d.output.layers.arrows import Ruler, Sign, arrow
from mars2d.output.layers.forces import SLIP, SLIP_EDGE, force_scale
from mars2d.output.layers.impulses import FRICTION, impulse_scale
from mars2d.output.layers.messages import LOST_LINK
from mars2d.output.layers.velocities import VELOCITY, speed_scale
from mars2d.scenario.scenario import Scenario

SIGNED = ("messages", "theory", "sensors")
"""The layers whose signs have a legend in pictures without plates, too."""
ROW = 16.0
"""The height of a row of signs without a plate, points."""


class Legend(NamedTuple):
    """The legend of a layer, by the layer's name."""

    layer: str
    signs: tuple[Sign, ...]
    ruler: Ruler | None = None


def legends(scenario: Scenario) -> list[Legend]:
    """Return the legends of all layers that have one in an experiment; none without robots."""
    if not scenario.robots:
        return []
    newtons, paces, blow = force_scale(scenario), speed_scale(scenario), impulse_scale(scenario)
    rubbing = Sign(_rubbing(), 24.0, "friction, and its cone")
    turning = Sign(_turning(), 24.0, "turn in 1 s")
    found = [
        Legend("forces", (newtons.limit, Sign(_slipping(), 18.0, "slips")), newtons),
        Legend("impulses", (blow.limit, rubbing), blow),
        Legend("velocities", (paces.limit, turning), paces),
    ]
    if signs := _of_sensors(scenario):
        found.append(Legend("sensors", signs))
    if any(addon.carries_messages for addon in scenario.addons):
        signs = Sign(_message(), 28.0, "message"), Sign(_lost(), 28.0, "message lost")
        found.append(Legend("messages", signs))
    if any(type(addon).theory is not Addon.theory for addon in scenario.addons):
        found.append(Legend("theory", (Sign(_theory(), 28.0, "theory"),)))
    return found


def sign_rows(shown: Sequence[Legend], corner: Point, point: float) -> Scene:
    """Return the signs of legends with their meanings, in rows above a corner (x, y) [m].

    point: how long a point is, metres. For pictures without plates.
    """
    scene, signs = Scene(), [sign for legend in shown for sign in legend.signs]
    column = max((sign.room for sign in signs), default=0.0)
    for k, sign in enumerate(signs):
        level = corner[1] + ROW * (k + 0.5) * point
        middle = corner[0] + column / 2 * point, level
        scene.extend(_moved(shape, middle, point) for shape in sign.scene.shapes)
        place = corner[0] + (column + 2.0) * point, level
        scene.text(place, sign.meaning, color=sign.color, anchor="left", halo="#ffffff")
    return scene


def _moved(shape: Shape, to: Point, point: float) -> Shape:
    """Return a shape of a sign, which is in points round (0, 0), in metres round a point."""
    if isinstance(shape, Circle):
        (x, y), radius = shape.center, point * shape.radius
        return replace(shape, center=(to[0] + point * x, to[1] + point * y), radius=radius)
    if isinstance(shape, Line | Polygon):
        return replace(shape, points=np.array(to) + point * shape.points)
    if isinstance(shape, Arrow):
        (ax, ay), (bx, by) = shape.tail, shape.tip
        tail = to[0] + point * ax, to[1] + point * ay
        return replace(shape, tail=tail, tip=(to[0] + point * bx, to[1] + point * by))
    return shape


def _of_sensors(scenario: Scenario) -> tuple[Sign, ...]:
    """Return a sign for each kind of sensors that has one."""
    found: dict[str, Sign] = {}
    for robot, color in zip(scenario.robots, scenario.colors, strict=True):
        for sensor in robot.sensors:
            scene = Scene()
            with called(f"sensor {sensor.key!r}", sensor.sign):
                meaning = sensor.sign(scene, color)
            if meaning:
                found.setdefault(meaning, Sign(scene, 28.0, meaning))
    return tuple(found.values())


def _message() -> Scene:
    """Return the sign of a message on its way."""
    scene = Scene()
    scene.line([(-12, 0), (12, 0)], stroke=faded(PALETTE[0], 0.5), width=1.1)
    scene.arrow((-6, 0), (6, 0), fill=faded(PALETTE[0], 0.9), width=2.2)
    return scene


def _lost() -> Scene:
    """Return the sign of a link over which nothing gets through."""
    scene = Scene()
    scene.line([(-12, 0), (12, 0)], stroke=faded(LOST_LINK, 0.75), width=1.1, style="--")
    scene.cross((0, 0), 4.0, stroke=LOST_LINK, width=2.2)
    return scene


def _theory() -> Scene:
    """Return the sign of a prediction."""
    scene = Scene()
    scene.line([(-12, 0), (12, 0)], stroke=THEORY, width=2.0)
    return scene


def _rubbing() -> Scene:
    """Return the sign of the friction of a blow, in its cone."""
    scene, apex = Scene(), np.array([-11.0, 0.0])
    scene.sector(
        (*apex, 0.0), 22.0, 0.9, fill=faded(FRICTION, 0.16), stroke=faded(FRICTION, 0.7), width=1.2
    )
    arrow(scene, apex + np.array([15.0, -5.0]), np.array([0.0, 11.0]), fill=FRICTION, width=2.0)
    return scene


def _slipping() -> Scene:
    """Return the sign of a drive that slips."""
    scene = Scene()
    for color, width in ((SLIP_EDGE, 5.0), (SLIP, 3.0)):
        scene.circle((0, 0), 0.0, stroke=color, width=width, pixels=6.0)
    return scene


def _turning() -> Scene:
    """Return the sign of turning."""
    scene, angles, radius = Scene(), np.linspace(-0.6, 2.6, 16), 9.0
    rim = np.array([0.0, -radius / 3]) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    scene.line(rim[:-2], stroke=VELOCITY, width=2.0)
    scene.arrow(rim[-6], rim[-1], fill=VELOCITY, width=2.0)
    return scene
