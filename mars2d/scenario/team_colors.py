"""The colours of a team: one after the other, and by group where there are many robots."""

from __future__ import annotations

import re
from collections.abc import Hashable, Sequence

from mars2d.core.scene import PALETTE, color_of, rgb
from mars2d.core.usercode import name_of
from mars2d.scenario.robot import Robot

CROWD = 20
"""More robots than this have the colour of their group, if the base colours are the default."""

SHADES = ((0.0, 0.0), (0.35, 1.0), (0.3, 0.0))
"""How members of a group differ in turn: by a share of white (1.0) or black (0.0)."""


def team_colors(robots: Sequence[Robot], base: Sequence[str]) -> tuple[str, ...]:
    """Return the colour of each robot: its own, or one of the base colours.

    A crowd is coloured by groups: robots of the same name but for its number, the same law, drive
    and size. Neighbours in a group differ in lightness.
    """
    if len(robots) <= CROWD or tuple(base) != PALETTE:
        return tuple(robot.color or base[i % len(base)] for i, robot in enumerate(robots))
    groups: dict[Hashable, list[int]] = {}
    colors = []
    for i, robot in enumerate(robots):
        members = groups.setdefault(_group(robot), [])
        members.append(i)
        place = list(groups).index(_group(robot)) % len(base)
        share, white = SHADES[(len(members) - 1) % len(SHADES)]
        shaded = color_of(value + share * (white - value) for value in rgb(base[place]))
        colors.append(robot.color or shaded)
    return tuple(colors)


def _group(robot: Robot) -> Hashable:
    """Return the properties that robots of one group have in common."""
    law = None if robot.controller is None else name_of(robot.controller)
    return re.sub(r"\d+$", "", str(robot.name)), law, type(robot.drive).__name__, robot.radius
