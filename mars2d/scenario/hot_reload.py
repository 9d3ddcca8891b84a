"""Hot reload: a scenario read from its file again, and how much of it a run can take over."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection
from typing import Any

from mars2d.bodies.props.base import Prop
from mars2d.core.description import Description
from mars2d.core.usercode import name_of
from mars2d.scenario.changes import FREE, check_same
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

__all__ = ["alike", "carried", "check_alike", "merged"]

WHOLE = FREE - {"robots", "props", "addons"}
"""Fields of a scenario that may change while its world runs, each as a whole."""


def alike(first: Any, second: Any) -> bool:
    """Return whether two values are the same except for code that was run twice.

    Running a file again makes new classes and functions of the same names.
    """
    if first is second:
        return True
    if isinstance(first, Description) and isinstance(second, Description):
        return type(first).__qualname__ == type(second).__qualname__ and all(
            hasattr(second, f.name) and alike(getattr(first, f.name), getattr(second, f.name))
            for f in dataclasses.fields(first)
        )
    if isinstance(first, (tuple, list)) and isinstance(second, (tuple, list)):
        return first == second or (len(first) == len(second) and all(map(alike, first, second)))
    if callable(first) and callable(second):
        return name_of(first) == name_of(second)
    return bool(first == second)


def check_alike(before: Scenario, after: Scenario) -> None:
    """Refuse a scenario read again if a run can't go on with it; the InputError says why not.

    Laws may have changed, and what `mars2d.scenario.changes` allows.
    """
    there = {addon.key: addon for addon in before.addons}
    addons = [_recognised(there.get(addon.key), addon) for addon in after.addons]
    changes: dict[str, Any] = {"addons": addons}
    for name in ("robots", "props"):
        parts = getattr(before, name), getattr(after, name)
        if len(parts[0]) == len(parts[1]):
            changes[name] = [_body(one, other) for one, other in zip(*parts, strict=True)]
    for field in dataclasses.fields(Scenario):
        if field.name not in changes:
            one, other = getattr(before, field.name), getattr(after, field.name)
            changes[field.name] = _recognised(one, other)
    check_same(before, after.replace(**changes))


def _recognised(before: Any, after: Any) -> Any:
    return before if alike(before, after) else after


def _body(before: Robot | Prop, after: Robot | Prop) -> Robot | Prop:
    """Return a robot or prop as before in all fields that are alike, except its law."""
    if type(before).__qualname__ != type(after).__qualname__:
        return after
    names = [f.name for f in dataclasses.fields(after) if f.name != "controller"]
    return before.replace(
        **{name: _recognised(getattr(before, name), getattr(after, name)) for name in names}
    )


def carried(fresh: Scenario, kept: Scenario, given: Collection[str | None] = ()) -> Scenario:
    """Return a scenario read again, with everything that may change as in `kept`.

    Its laws, and other parts with code, are those of `fresh`. given: the names of robots whose laws
    are those of `kept`.
    """
    read = {addon.key: addon for addon in fresh.addons}
    return fresh.replace(
        **{name: getattr(kept, name) for name in WHOLE},
        addons=[_recognised(read.get(a.key), a) if a.key in read else a for a in kept.addons],
        robots=[
            robot.replace(controller=other.controller) if robot.name in given else robot
            for robot, other in zip(_moved(fresh.robots, kept.robots), kept.robots, strict=True)
        ],
        props=_moved(fresh.props, kept.props),
    )


def _moved(fresh: Any, kept: Any) -> list[Any]:
    """Return bodies with the poses and colours of others."""
    return [a.replace(pose=b.pose, color=b.color) for a, b in zip(fresh, kept, strict=True)]


def merged(before: Scenario, after: Scenario, live: Scenario) -> Scenario:
    """Return a live scenario with those of its parts changed that differ in its file.

    before, after: as the file had them when it was read, and as it has them now.
    """
    changes: dict[str, Any] = {
        name: getattr(after, name)
        for name in (*WHOLE, "addons")
        if not alike(getattr(before, name), getattr(after, name))
    }
    for name in ("robots", "props"):
        bodies = zip(*(getattr(s, name) for s in (before, after, live)), strict=True)
        changes[name] = [
            there if one.color == other.color else there.replace(color=other.color)
            for one, other, there in bodies
        ]
    return live.replace(**changes)
