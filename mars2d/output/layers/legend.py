"""What the marks of a layer mean: arrows of a round length, and signs with a few words."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mars2d.addons.base import Addon
from mars2d.core.scene import (
    PALETTE,
    THEORY,
    Arrow,
    Circle,
    Line,
    Scene,
    Shape,
    faded,
)
from mars2d.output.layers.arrows import Ruler, Sign, arrow
from mars2d.output.layers.forces import SLIP, SLIP_EDGE, force_scale
from mars2d.output.layers.impulses import FRICTION, impulse_scale
from mars2d.output.layers.messages import LOST_LINK
from mars2d.output.layers.velocities import speed_scale
from mars2d.scenario.scenario import Scenario


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
        Legend("velocities", (paces.limit,), paces),
    ]
    if any(addon.carries_messages for addon in scenario.addons):
        found.append(Legend("messages", (MESSAGE, LOST)))
    if any(type(addon).theory is not Addon.theory for addon in scenario.addons):
        found.append(Legend("theory", (PREDICTED,)))
    return found


def _friction() -> Sign:
    """Return the sign of the friction of a blow, in its cone."""
    scene, apex, color = Scene(), np.array([-11.0, 0.0]), faded(FRICTION, 0.7)
    scene.sector((*apex, 0.0), 22.0, 0.9, fill=faded(FRICTION, 0.16), stroke=color, width=1.2)
    arrow(scene, apex + np.array([15.0, -5.0]), np.array([0.0, 11.0]), fill=FRICTION, width=2.0)
    return Sign(scene, 24.0, "friction, and its cone")


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
