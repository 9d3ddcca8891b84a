"""Changes of a scenario that a running world takes: bodies elsewhere, and a file read again."""

from __future__ import annotations

import dataclasses
import operator
from collections.abc import Callable, Collection, Iterator, Set
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import Description
from mars2d.core.errors import InputError, counted
from mars2d.core.usercode import name_of
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.starts import faults

Float = NDArray[np.float64]
Same = Callable[[Any, Any], bool]

MECHANICAL = frozenset(
    {"mass", "moment", "material", "friction", "restitution", "static_friction"}
    | {"ground_friction", "static_ground_friction"}
)
"""Fields of bodies that may change, and with which the engine starts again."""

WHOLE = frozenset({"title", "workspace", "on_exit", "stop_time", "stop_on", "animation"})
"""Fields of a scenario that may change while its world runs, each as a whole."""

PARTS = {
    "robots": MECHANICAL | {"pose", "color", "drive"},
    "props": MECHANICAL | {"pose", "color"},
    "joints": frozenset({"stiffness", "damping"}),
}
"""The lists of parts, and the fields of each part that may change, as a robot's law may."""


def check_same(before: Scenario, after: Scenario, same: Same = operator.eq) -> None:
    """Refuse a scenario that a running world can't go on with; the InputError says why not.

    same: decides whether two values are the same: `alike` for a scenario that was read again, whose
    laws may have changed.
    """
    for what in hindrances(before, after, same):
        raise InputError(f"this needs a new start: {what}")


def hindrances(before: Scenario, after: Scenario, same: Same) -> Iterator[str]:
    """Yield the reasons why a world can't go on."""
    for name in _differing(before, after, same, {*WHOLE, *PARTS, "addons"}):
        yield f"Scenario.{name} is another one"
    for family, free in PARTS.items():
        first, second = getattr(before, family), getattr(after, family)
        if len(first) != len(second):
            yield f"{counted(len(second), family[:-1])} in place of {len(first)}"
        for k, (one, other) in enumerate(zip(first, second, strict=True)):
            what = getattr(one, "name", f"Scenario.joints[{k}]")
            if not _same_kind(one, other):
                yield f"{what} is a {type(other).__name__} now"
            for name in _differing(one, other, same, free | {"controller"}):
                yield f"{name} of {what} is another one"
    for one, other in zip(before.robots, after.robots, strict=True):
        drives, what = (one.drive, other.drive), f"drive of {one.name}"
        if not same(*drives) and (one.drive.noise or not _same_kind(*drives)):
            yield f"{what} is another one{', and has noise' * bool(one.drive.noise)}"
        for name in ("noise", "dead_time"):  # the others may change, but not beside noise
            if getattr(one.drive, name) != getattr(other.drive, name):
                yield f"{what} has another {name}"
    busy = [{a.key: a for a in scenario.addons if a.acts} for scenario in (before, after)]
    for key in sorted({*busy[0], *busy[1]}):
        if not same(busy[0].get(key), busy[1].get(key)):
            yield f"the add-on {key!r}, which does something at each step, is another one"


def moves_alike(before: Scenario, after: Scenario) -> bool:
    """Return whether bodies and joints of both scenarios answer forces in the same way.

    For a scenario that `check_same` lets pass: else an engine has to start again.
    """
    pairs = zip([*before.robots, *before.props], [*after.robots, *after.props], strict=True)
    return before.joints == after.joints and all(
        getattr(one, name, None) == getattr(other, name, None)
        for one, other in pairs
        for name in (*MECHANICAL, "drive")
    )


def _same_kind(before: object, after: object) -> bool:
    """Return whether two are of one class, which may be of a file that was run twice."""
    return type(before).__qualname__ == type(after).__qualname__


def _differing(before: Any, after: Any, same: Same, free: Set[str] = frozenset()) -> Iterator[str]:
    """Yield the fields that differ in two descriptions, except those that are free."""
    for name in (field.name for field in dataclasses.fields(before)):
        if name not in free and not same(getattr(before, name), getattr(after, name, None)):
            yield name


def with_poses(scenario: Scenario, poses: Float) -> Scenario:
    """Return the scenario with its bodies at poses (3, N), checked.

    A scenario with joints is returned unchanged, since lengths may be those at the start. So is one
    with robots inside each other, which physics="ideal" allows.
    """
    if scenario.ties:
        for body, rigid in enumerate(scenario.bodies):
            fault = obstruction(scenario, poses, body)
            if fault:
                raise InputError(f"{rigid.name} would {fault}")
        return scenario
    at = [tuple(pose) for pose in poses.T.tolist()]
    n = len(scenario.robots)
    try:
        return scenario.replace(
            robots=[r.replace(pose=p) for r, p in zip(scenario.robots, at[:n], strict=True)],
            props=[p.replace(pose=q) for p, q in zip(scenario.props, at[n:], strict=True)],
        )
    except InputError:
        if scenario.physics == "ideal":
            return scenario
        raise


def obstruction(scenario: Scenario, poses: Float, body: int) -> str:
    """Return the reason why a body can't be where it is, such as "overlap red", or "".

    poses: (3, N) of all bodies; only that body is checked. With physics="ideal" nothing is in the
    way.
    """
    bodies = [
        rigid._replace(pose=tuple(pose))
        for rigid, pose in zip(scenario.bodies, poses.T.tolist(), strict=True)
    ]
    fault = next(faults(scenario, bodies, body), None)
    if fault is None:
        return ""
    if fault.kind == "overlap":
        return f"overlap {bodies[fault.other if fault.body == body else fault.body].name}"
    return {
        "obstacle": f"be in obstacle {fault.other}",
        "outside": "be outside of the workspace",
        "wall": "be in the workspace's wall",
    }[fault.kind]


def alike(first: Any, second: Any) -> bool:
    """Return whether two values are the same except for code that was run twice.

    Running a file again makes new classes and functions of the same names.
    """
    if first is second:
        return True
    if isinstance(first, Description) and isinstance(second, Description):
        return _same_kind(first, second) and not any(_differing(first, second, alike))
    if isinstance(first, (tuple, list)) and isinstance(second, (tuple, list)):
        return first == second or (len(first) == len(second) and all(map(alike, first, second)))
    if callable(first) and callable(second):
        return name_of(first) == name_of(second)
    return bool(first == second)


def carried(fresh: Scenario, kept: Scenario, given: Collection[str | None] = ()) -> Scenario:
    """Return a scenario read again, with everything that may change as in `kept`.

    Its laws, and other parts with code, are those of `fresh`. given: the names of robots whose laws
    are those of `kept`.
    """
    read = {addon.key: addon for addon in fresh.addons}
    addons = [read[a.key] if alike(read.get(a.key), a) else a for a in kept.addons]
    found = _with_changes(fresh, fresh, kept, addons=addons)
    laws = {r.name: r.controller for r in kept.robots if r.name in given}
    return found.with_laws([laws.get(r.name, r.controller) for r in found.robots])


def merged(before: Scenario, after: Scenario, live: Scenario) -> Scenario:
    """Return a live scenario with those of its parts changed that differ in its file.

    before, after: as the file had them when it was read, and as it has them now.
    """
    addons = live.addons if alike(before.addons, after.addons) else after.addons
    return _with_changes(live, before, after, {"pose"}, addons=addons)


def _with_changes(
    target: Scenario, before: Scenario, after: Scenario, kept: Set[str] = frozenset(), **more: Any
) -> Scenario:
    """Return a scenario with what differs in two others, but for fields `kept` of its parts.

    more: other fields that change.
    """
    differing = [name for name in _differing(before, after, alike) if name in WHOLE]
    changes = {name: getattr(after, name) for name in differing} | more
    for family, free in PARTS.items():
        parts = zip(*(getattr(each, family) for each in (before, after, target)), strict=True)
        changes[family] = [
            part.replace(
                **{
                    name: getattr(other, name)
                    for name in _differing(one, other, alike)
                    if name in free - kept
                }
            )
            for one, other, part in parts
        ]
    return target.replace(**changes)
