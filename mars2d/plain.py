"""Scenarios as plain data: what a file can hold, without code."""

from __future__ import annotations

import dataclasses
from typing import Any

from mars2d.addons.base import Addon
from mars2d.addons.map import Map
from mars2d.animation import Animation
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
        kind = type(value).__name__
        if isinstance(value, Addon) and kind not in members("addons"):
            # Its code is not in the file, but where it put obstacles is.
            fields["obstacles"] = from_description(value.obstacles())
        return {"type": kind, **fields}
    if isinstance(value, (list, tuple)):
        return [from_description(item) for item in value]
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    return getattr(value, "__name__", type(value).__name__)


def to_scenario(data: Any) -> Scenario:
    """Return the scenario that `from_description` made plain, as far as its parts are known here.

    Laws do not come back, nor do sensors and add-ons of the user's own; of such an add-on the
    obstacles do. Raises InputError for anything that is no scenario.
    """
    result = _to_description(data)
    if not isinstance(result, Scenario):
        raise InputError(f"expected a scenario, found {type(result).__name__}")
    return result


def _to_description(value: Any) -> Any:
    if isinstance(value, list):
        items = [_to_description(item) for item in value]
        return [item for item in items if item is not _UNKNOWN]
    if not isinstance(value, dict):
        return value
    fields = {k: _to_description(v) for k, v in value.items() if k not in ("type", "controller")}
    kinds: dict[str, Any] = {"Scenario": Scenario, "Robot": Robot, "Animation": Animation}
    kinds |= members("bodies") | members("sensors") | members("addons")
    kind = kinds.get(value.get("type", ""))
    if kind is not None:
        return kind(**fields)
    if fields.get("obstacles"):
        return Map(fields["obstacles"], name=fields.get("name"))
    return _UNKNOWN


_UNKNOWN = object()
