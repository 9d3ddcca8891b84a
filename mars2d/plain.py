"""Scenarios as plain data: what a file can hold, without code."""

from __future__ import annotations

import dataclasses
from typing import Any

from mars2d.addons.base import Addon
from mars2d.addons.map import Map
from mars2d.animation import Animation
from mars2d.bodies.base import Drive
from mars2d.bodies.unicycle import Unicycle
from mars2d.description import Description
from mars2d.errors import InputError
from mars2d.registry import members
from mars2d.robot import Robot
from mars2d.scenario import Scenario

__all__ = ["from_description", "to_scenario"]


def from_description(value: Any) -> Any:
    """Return a description as dicts, lists, text and numbers; a law is its name."""
    if isinstance(value, Description):
        fields = {
            f.name: from_description(getattr(value, f.name)) for f in dataclasses.fields(value)
        }
        kind = type(value)
        if kind.__module__.startswith("mars2d."):
            return {"type": kind.__name__, **fields}
        # The code of the user's own parts is not in the file; what matters to motion is.
        if isinstance(value, Addon):
            fields["obstacles"] = from_description(value.obstacles())
        return {"type": kind.__name__, "own": _family(value), **fields}
    if isinstance(value, (list, tuple)):
        return [from_description(item) for item in value]
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    return getattr(value, "__name__", type(value).__name__)


def _family(value: Description) -> str:
    if isinstance(value, Drive):
        return "drive"
    return "add-on" if isinstance(value, Addon) else "sensor"


def to_scenario(data: Any) -> tuple[Scenario, tuple[str, ...]]:
    """Return the scenario that `from_description` made plain, and what is missing of it.

    Laws do not come back, nor does what is of the user's own: sensors and add-ons are left out,
    but for obstacles, and a drive is replaced by a Unicycle; they are named in the second value,
    as ``sensor Eyes``. Raises InputError for anything that is no scenario.
    """
    missing: list[str] = []
    result = _to_description(data, missing)
    if not isinstance(result, Scenario):
        raise InputError(f"expected a scenario, found {type(result).__name__}")
    return result, tuple(dict.fromkeys(missing))


def _to_description(value: Any, missing: list[str]) -> Any:
    if isinstance(value, list):
        items = [_to_description(item, missing) for item in value]
        return [item for item in items if item is not _LEFT_OUT]
    if not isinstance(value, dict):
        return value
    unread = ("type", "own", "controller")
    fields = {k: _to_description(v, missing) for k, v in value.items() if k not in unread}
    if "own" in value:
        missing.append(f"{value['own']} {value['type']}")
        return _stand_in(value["own"], fields)
    kinds: dict[str, Any] = {"Scenario": Scenario, "Robot": Robot, "Animation": Animation}
    kinds |= members("bodies") | members("sensors") | members("addons")
    return kinds[value["type"]](**fields)


def _stand_in(family: str, fields: dict[str, Any]) -> Any:
    """Return what stands for a part of the user's own, or that it is left out."""
    if family == "drive":
        return Unicycle(**{f.name: fields[f.name] for f in dataclasses.fields(Drive)})
    if family == "add-on" and fields["obstacles"]:
        kept = {f.name: fields[f.name] for f in dataclasses.fields(Addon)}
        return Map(fields["obstacles"], **kept)
    return _LEFT_OUT


_LEFT_OUT = object()
