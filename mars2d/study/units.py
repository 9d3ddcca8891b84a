"""Units of settings that are fields of the package."""

from __future__ import annotations

import dataclasses

from mars2d.core.description import Description
from mars2d.scenario.animation import Animation
from mars2d.scenario.neighbours import Within
from mars2d.scenario.registry import members
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

FAMILY = {"drive": "bodies"} | {name: name for name in ("props", "joints", "sensors", "addons")}
"""The families of parts by the names of the fields that hold them."""

HOLDERS: dict[str, type[Description]] = {
    "": Scenario, "robots": Robot, "animation": Animation, "neighbours": Within,
}  # fmt: skip
"""The classes of all other parts by the names of the fields that hold them."""


def unit_of_field(setting: str) -> str:
    """Return the unit of the field that a setting sets; empty if it is none, or of several units.

    >>> [unit_of_field(name) for name in ("stop_time", "robots.*.mass", "n")]
    ['s', 'kg', '']
    """
    *path, last = setting.split(".")
    holder = next((part for part in reversed(path) if part != "*" and not part.isdigit()), "")
    kinds = members(FAMILY[holder]).values() if holder in FAMILY else [HOLDERS.get(holder)]
    fields = [each for kind in kinds if kind is not None for each in dataclasses.fields(kind)]
    units = {str(each.metadata.get("unit", "")) for each in fields if each.name == last}
    return units.pop() if len(units) == 1 else ""


def with_unit(text: str, unit: str) -> str:
    """Return a name, followed by its unit in brackets if it has one."""
    return f"{text} [{unit}]" if unit else text
