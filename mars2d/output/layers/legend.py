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
    found = [
        Legend("forces", (newtons.limit, SLIPS), newtons),
        Legend("impulses", (blow.limit, _friction()), blow),
        Legend("velocities", (paces.limit, _turning()), paces),
    ]
    if signs := _of_sensors(scenario):
        found.append(Legend("sensors", signs))
    if any(addon.carries_messages for addon in scenario.addons):
        found.append(Legend("messages", (MESSAGE, LOST)))
    if any(type(addon).theory is not Addon.theory for addon in scenario.addons):
        found.append(Legend("theory", (PREDICTED,)))
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

    def at(end: Point) -> Point:
        return to[0] + point * end[0], to[1] + point * end[1]

    if isinstance(shape, Circle):
        return replace(shape, center=at(shape.center), radius=point * shape.radius)
    if isinstance(shape, Line | Polygon):
        return replace(shape, points=np.array(to) + point * shape.points)
    if isinstance(shape, Arrow):
        return replace(shape, tail=at(shape.tail), tip=at(shape.tip))
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


def _friction() -> Sign:
    """Return the sign of the friction of a blow, in its cone."""
    scene, apex, color = Scene(), np.array([-11.0, 0.0]), faded(FRICTION, 0.7)
    scene.sector((*apex, 0.0), 22.0, 0.9, fill=faded(FRICTION, 0.16), stroke=color, width=1.2)
    arrow(scene, apex + np.array([15.0, -5.0]), np.array([0.0, 11.0]), fill=FRICTION, width=2.0)
    return Sign(scene, 24.0, "friction, and its cone")


def _turning() -> Sign:
    """Return the sign of turning."""
    scene, angles, radius = Scene(), np.linspace(-0.6, 2.6, 16), 9.0
    rim = np.array([0.0, -radius / 3]) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    scene.line(rim[:-2], stroke=VELOCITY, width=2.0)
    scene.arrow(rim[-6], rim[-1], fill=VELOCITY, width=2.0)
    return Sign(scene, 24.0, "turn in 1 s")


def _sign(meaning: str, room: float, *shapes: Shape) -> Sign:
    return Sign(Scene([*shapes]), room, meaning)


ALONG = np.array([(-12.0, 0.0), (12.0, 0.0)])
CROSS = [np.array([(-4.0, -up), (4.0, up)]) for up in (4.0, -4.0)]

MESSAGE = _sign(
    "message", 28.0,
    Line(ALONG, faded(PALETTE[0], 0.5), 1.1),
    Arrow((-6.0, 0.0), (6.0, 0.0), faded(PALETTE[0], 0.9), width=2.2),
)  # fmt: skip
LOST = _sign(
    "message lost", 28.0,
    Line(ALONG, faded(LOST_LINK, 0.75), 1.1, "--"),
    *(Line(stroke, LOST_LINK, 2.2) for stroke in CROSS),
)  # fmt: skip
PREDICTED = _sign("theory", 28.0, Line(ALONG, THEORY, 2.0))
SLIPS = _sign(
    "slips", 18.0,
    *(
        Circle((0.0, 0.0), 0.0, stroke=color, width=width, pixels=6.0)
        for color, width in ((SLIP_EDGE, 5.0), (SLIP, 3.0))
    ),
)  # fmt: skip
