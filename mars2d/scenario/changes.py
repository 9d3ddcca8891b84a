"""Changes of a scenario: which ones a running world takes, and which need a new start."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, counted
from mars2d.scenario.placement import obstruction
from mars2d.scenario.scenario import Scenario

__all__ = ["check_same", "with_poses"]

Float = NDArray[np.float64]

FREE = frozenset(
    {"title", "robots", "props", "workspace", "on_exit", "stop_time", "addons", "animation"}
)
"""Fields of a scenario that may change; robots, props and add-ons in some ways only."""

FREE_OF_BODIES = frozenset({"pose", "color"})
FREE_OF_ROBOTS = FREE_OF_BODIES | {"controller"}


def check_same(before: Scenario, after: Scenario) -> None:
    """Refuse a scenario that a running world can't go on with; the InputError says why not."""
    for field in dataclasses.fields(Scenario):
        if field.name not in FREE and getattr(before, field.name) != getattr(after, field.name):
            raise _needs_new_start(f"Scenario.{field.name} is another one")
    _check_bodies("robots", FREE_OF_ROBOTS, before, after)
    _check_bodies("props", FREE_OF_BODIES, before, after)
    busy = [{a.key: a for a in scenario.addons if a.acts} for scenario in (before, after)]
    for key in sorted({*busy[0], *busy[1]}):
        if busy[0].get(key) != busy[1].get(key):
            raise _needs_new_start(
                f"the add-on {key!r}, which does something at each step, is another one"
            )


def _check_bodies(name: str, free: frozenset[str], before: Scenario, after: Scenario) -> None:
    first, second = getattr(before, name), getattr(after, name)
    if len(first) != len(second):
        raise _needs_new_start(f"{counted(len(second), name[:-1])} in place of {len(first)}")
    for one, other in zip(first, second, strict=True):
        if type(one) is not type(other):
            raise _needs_new_start(f"{one.name} is a {type(other).__name__} now")
        for field in dataclasses.fields(one):
            here, there = getattr(one, field.name), getattr(other, field.name)
            if field.name not in free and here != there:
                raise _needs_new_start(f"{field.name} of {one.name} is another one")


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
