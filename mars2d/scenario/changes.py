"""Changes of a scenario that a running world takes: bodies elsewhere, and a file read again."""

from __future__ import annotations

import dataclasses
import operator
from collections.abc import Callable, Collection, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.drives.base import Drive
from mars2d.core.arithmetic import norm
from mars2d.core.description import Description
from mars2d.core.errors import InputError, counted
from mars2d.core.usercode import name_of
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.starts import check_in_workspace, check_off_walls, cut_by, depth

Float = NDArray[np.float64]
Same = Callable[[Any, Any], bool]

FREE = frozenset(
    {"title", "robots", "props", "joints", "workspace", "on_exit", "stop_time", "addons"}
    | {"animation"}
)
"""Fields of a scenario that may change; robots, props, joints and add-ons in some ways only."""

MECHANICAL = frozenset(
    {"mass", "moment", "material", "friction", "restitution", "static_friction"}
    | {"ground_friction", "static_ground_friction"}
)
"""Fields of bodies that may change, and with which the engine starts again."""

FREE_OF_BODIES = MECHANICAL | {"pose", "color"}
FREE_OF_ROBOTS = FREE_OF_BODIES | {"drive", "controller"}

FIXED_OF_DRIVES = frozenset({"noise", "dead_time"})
"""Fields of drives that may not change; of a drive with noise, none may."""

FREE_OF_JOINTS = frozenset({"stiffness", "damping"})
"""Fields of joints that may change."""

WHOLE = FREE - {"robots", "props", "joints", "addons"}
"""Fields of a scenario that may change while its world runs, each as a whole."""

PARTS = {
    "robots": FREE_OF_ROBOTS - {"controller"},
    "props": FREE_OF_BODIES,
    "joints": FREE_OF_JOINTS,
}
"""The lists of parts, and the fields of each part that may change."""


def check_same(before: Scenario, after: Scenario, same: Same = operator.eq) -> None:
    """Refuse a scenario that a running world can't go on with; the InputError says why not.

    same: decides whether two values are the same.
    """
    for name in _changed(before, after, FREE, same):
        raise _needs_new_start(f"Scenario.{name} is another one")
    for family, free in (("robots", FREE_OF_ROBOTS), ("props", FREE_OF_BODIES)):
        first, second = getattr(before, family), getattr(after, family)
        if len(first) != len(second):
            raise _needs_new_start(f"{counted(len(second), family[:-1])} in place of {len(first)}")
        for one, other in zip(first, second, strict=True):
            if not _same_kind(one, other):
                raise _needs_new_start(f"{one.name} is a {type(other).__name__} now")
            for name in _changed(one, other, free, same):
                raise _needs_new_start(f"{name} of {one.name} is another one")
    for one, other in zip(before.robots, after.robots, strict=True):
        if not same(one.drive, other.drive):
            _check_drive(f"drive of {one.name}", one.drive, other.drive)
    joints = [*zip(before.joints, after.joints, strict=False)]
    kept = all(
        _same_kind(*pair) and not [*_changed(*pair, FREE_OF_JOINTS, same)] for pair in joints
    )
    if len(before.joints) != len(after.joints) or not kept:
        raise _needs_new_start("Scenario.joints is another one")
    busy = [{a.key: a for a in scenario.addons if a.acts} for scenario in (before, after)]
    for key in sorted({*busy[0], *busy[1]}):
        if not same(busy[0].get(key), busy[1].get(key)):
            raise _needs_new_start(
                f"the add-on {key!r}, which does something at each step, is another one"
            )


def moves_alike(before: Scenario, after: Scenario) -> bool:
    """Return whether bodies and joints of both scenarios answer forces in the same way.

    For a scenario that `check_same` lets pass: else an engine has to start again.
    """
    if before.joints != after.joints:
        return False
    pairs = [*zip(before.robots, after.robots, strict=True)]
    if any(one.drive != other.drive for one, other in pairs):
        return False
    return all(
        getattr(one, name, None) == getattr(other, name, None)
        for one, other in [*pairs, *zip(before.props, after.props, strict=True)]
        for name in MECHANICAL
    )


def _check_drive(name: str, before: Drive, after: Drive) -> None:
    if not _same_kind(before, after):
        raise _needs_new_start(f"{name} is another one")
    if before.noise:
        raise _needs_new_start(f"{name} is another one, and has noise")
    for field in FIXED_OF_DRIVES:
        if getattr(before, field) != getattr(after, field):
            raise _needs_new_start(f"{name} has another {field}")


def _same_kind(before: object, after: object) -> bool:
    """Return whether two are of one class, which may be of a file that was run twice."""
    return type(before).__qualname__ == type(after).__qualname__


def _changed(
    before: Description, after: Description, free: frozenset[str], same: Same
) -> Iterator[str]:
    """Yield the fields that differ, except those that are free; both are of one class."""
    for field in dataclasses.fields(before):
        here, there = (getattr(each, field.name, None) for each in (before, after))
        if field.name not in free and not same(here, there):
            yield field.name


def _needs_new_start(what: str) -> InputError:
    return InputError(f"this needs a new start: {what}")


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


def without_body(scenario: Scenario, body: int) -> Scenario:
    """Return the scenario without a robot or prop: an index of `Scenario.bodies`."""
    n = len(scenario.robots)
    return scenario.replace(
        robots=[robot for i, robot in enumerate(scenario.robots) if i != body],
        props=[prop for i, prop in enumerate(scenario.props) if i + n != body],
    )


def obstruction(scenario: Scenario, poses: Float, body: int) -> str:
    """Return the reason why a body can't be where it is, such as "overlap red", or "".

    poses: (3, N) of all bodies; only that body is checked. With physics="ideal" nothing is in the
    way.
    """
    bodies = [
        rigid._replace(pose=tuple(pose))
        for rigid, pose in zip(scenario.bodies, poses.T.tolist(), strict=True)
    ]
    here, overlap = bodies[body], scenario.max_overlap
    area = None if scenario.on_exit == "ignore" else scenario.workspace
    if area and body < len(scenario.robots) and _refused(check_in_workspace, [here], area):
        return "be outside of the workspace"
    if scenario.physics == "ideal":
        return ""
    if area and scenario.on_exit == "wall" and _refused(check_off_walls, [here], area, overlap):
        return "be in the workspace's wall"
    for k in cut_by(here, scenario.obstacles, overlap):
        return f"be in obstacle {k}"
    (cx, cy), radius = here.bound
    for k, other in enumerate(bodies):
        (x, y), reach = other.bound
        if k == body or norm(x - cx, y - cy) >= reach + radius:
            continue
        if (min(k, body), max(k, body)) not in scenario.joined and depth(here, other, overlap):
            return f"overlap {other.name}"
    return ""


def _refused(check: Callable[..., None], *given: Any) -> bool:
    try:
        check(*given)
    except InputError:
        return True
    return False


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
