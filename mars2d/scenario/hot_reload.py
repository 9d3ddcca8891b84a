"""Hot reload: a scenario read from its file again, and how much of it a run can take over."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection
from typing import Any

from mars2d.core.description import Description
from mars2d.core.usercode import name_of
from mars2d.scenario.changes import FREE, FREE_OF_BODIES, FREE_OF_JOINTS, FREE_OF_ROBOTS, check_same
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

WHOLE = FREE - {"robots", "props", "joints", "addons"}
"""Fields of a scenario that may change while its world runs, each as a whole."""

PARTS = {
    "robots": FREE_OF_ROBOTS - {"controller"},
    "props": FREE_OF_BODIES,
    "joints": FREE_OF_JOINTS,
}
"""The lists of parts, and the fields of each part that may change."""


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
    check_same(before, after, alike)


def carried(fresh: Scenario, kept: Scenario, given: Collection[str | None] = ()) -> Scenario:
    """Return a scenario read again, with everything that may change as in `kept`.

    Its laws, and other parts with code, are those of `fresh`. given: the names of robots whose laws
    are those of `kept`.
    """
    read = {addon.key: addon for addon in fresh.addons}
    return fresh.replace(
        **{name: getattr(kept, name) for name in WHOLE},
        addons=[read[a.key] if alike(read.get(a.key), a) else a for a in kept.addons],
        **{
            name: [
                one.replace(**_different(one, other, one, free | _given(one, given)))
                for one, other in zip(getattr(fresh, name), getattr(kept, name), strict=True)
            ]
            for name, free in PARTS.items()
        },
    )


def _given(part: Any, given: Collection[str | None]) -> frozenset[str]:
    """Return the field that a robot's law is in, if it was given one."""
    named = isinstance(part, Robot) and part.name in given
    return frozenset({"controller"} if named else ())


def _different(before: Any, after: Any, of: Any, free: frozenset[str]) -> dict[str, Any]:
    """Return the free fields that differ in two parts, with the values of the latter.

    of: a part that has them all.
    """
    return {
        field.name: getattr(after, field.name)
        for field in dataclasses.fields(of)
        if field.name in free and not alike(getattr(before, field.name), getattr(after, field.name))
    }


def merged(before: Scenario, after: Scenario, live: Scenario) -> Scenario:
    """Return a live scenario with those of its parts changed that differ in its file.

    before, after: as the file had them when it was read, and as it has them now.
    """
    changes: dict[str, Any] = {
        name: getattr(after, name)
        for name in (*WHOLE, "addons")
        if not alike(getattr(before, name), getattr(after, name))
    }
    for name, free in PARTS.items():
        parts = zip(*(getattr(s, name) for s in (before, after, live)), strict=True)
        changes[name] = [
            there.replace(**_different(one, other, there, free - {"pose"}))
            for one, other, there in parts
        ]
    return live.replace(**changes)
