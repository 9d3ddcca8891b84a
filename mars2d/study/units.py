"""Units: those of settings that are fields of the package, and those that are stated."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Collection, Iterable, Mapping

from mars2d.core.description import Description, wrong
from mars2d.core.errors import InputError, nearest
from mars2d.scenario.animation import Animation
from mars2d.scenario.neighbours import Within
from mars2d.scenario.registry import members
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

UNIT = re.compile(r"[^\[\]\x00-\x1f=,]{1,20}")
"""The form of a unit: a few letters, without the characters that separate it from its name."""

HEAD = re.compile(rf"(.*\S) \[({UNIT.pattern})\]")

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


def checked_units(given: Mapping[str, str] | None, known: Collection[str]) -> dict[str, str]:
    """Return units by the names of settings and measures. Raises InputError for other names."""
    if given is not None and not isinstance(given, Mapping):
        raise wrong("units", given, "a dict, such as {'spread': 'm'}")
    for name, unit in (given or {}).items():
        if name not in known:
            what = "there is no such setting or measure"
            raise InputError(f"unit of {name!r}: {what}{nearest(name, known)}")
        if not isinstance(unit, str) or not UNIT.fullmatch(unit) or unit != unit.strip():
            expected = "at most 20 letters without [ ] = and commas, such as 'm/s'"
            raise wrong(f"unit of {name!r}", unit, expected)
    return dict(given or {})


def parse_units(texts: Iterable[str]) -> dict[str, str]:
    """Return the units of NAME=UNIT from the command line.

    >>> parse_units(["spread=m", "gain=1/s"])
    {'spread': 'm', 'gain': '1/s'}
    """
    units: dict[str, str] = {}
    for text in texts:
        name, equals, unit = (part.strip() for part in text.partition("="))
        if not (name and equals and unit):
            raise InputError(f"--unit {text}: expected NAME=UNIT, such as --unit spread=m")
        if name in units:
            raise InputError(f"--unit {name}: is given twice")
        units[name] = unit
    return units


def with_unit(text: str, unit: str) -> str:
    """Return a name, followed by its unit in brackets if it has one."""
    return f"{text} [{unit}]" if unit else text


def name_and_unit(text: str) -> tuple[str, str]:
    """Return the name and the unit that `with_unit` has joined.

    >>> name_and_unit("spread [m]"), name_and_unit("spread")
    (('spread', 'm'), ('spread', ''))
    """
    found = HEAD.fullmatch(text)
    return (found[1], found[2]) if found else (text, "")
