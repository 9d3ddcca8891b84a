"""The observations of an isolated law: the part of a scenario and of a world that it may see.

A law's process gets a `Briefing` once, and what `look` returns at each control step. Neither holds
anything that the law's robots may not see.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.streams import stream
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.serialize import without_code
from mars2d.tournaments.isolation.limits import Limits

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

Float = NDArray[np.float64]


# -- once ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Briefing:
    """The message that a law's process gets once.

    file: of the law. code: the contents of this file and of those beside it that it imports, by
    path. hidden: the files of other laws. robots: the indices of the law's robots. scenario:
    without code; for laws that do not see the whole world, a part of it: their own robots, without
    their starts, and the names of the others. streams: the states of its robots' random streams, by
    their names. folder: the current one. chance: the seed of Python's and numpy's shared
    generators, so that a match can be repeated.
    """

    file: Path
    code: Mapping[Path, bytes]
    hidden: tuple[Path, ...]
    robots: tuple[int, ...]
    scenario: Any
    streams: Mapping[str, Any]
    limits: Limits
    folder: str
    chance: int


def brief(
    scenario: Scenario,
    role: str,
    files: Mapping[str, Path],
    code: Mapping[str, Mapping[Path, bytes]],
    robots: Sequence[int],
    seed: int,
    limits: Limits,
) -> Briefing:
    """Return the briefing of the law of a role, which holds only what it may see, and no seed.

    files, code: of all roles. robots: of this one.
    """
    visible: Any
    visible, _ = without_code(scenario.with_laws([None] * len(scenario.robots)))
    if not _sees_all(scenario, robots):
        known = [
            robot.at(0.0, 0.0) if i in robots else Robot(name=robot.name)
            for i, robot in enumerate(visible.robots)
        ]
        dt = scenario.sampling_time
        visible = SimpleNamespace(robots=tuple(known), sampling_time=dt, props=())
    names = [f"robot {scenario.robots[i].name}" for i in robots]
    return Briefing(
        file=files[role],
        code=code[role],
        hidden=tuple({path for each in code.values() for path in each} - {*code[role]}),
        robots=tuple(robots),
        scenario=visible,
        streams={name: dict(stream(seed, name).bit_generator.state) for name in names},
        limits=limits,
        folder=os.getcwd(),  # noqa: PTH109 - as text
        chance=int(stream(seed, f"law of {role}").integers(2**32)),
    )


def _sees_all(scenario: Scenario, robots: Sequence[int]) -> bool:
    return any(scenario.robots[i].sees == "full" for i in robots)


# -- at each control step --------------------------------------------------------------------------


def look(world: Simulation, robots: Sequence[int]) -> dict[str, Any]:
    """Return what the law of some robots sees of a world now, by the names of its attributes.

    NaN is what it may not see. contacts: the bytes of their rows. neighbours, readings, inbox: by
    the robots' indices. Errors of sensors pass through.
    """
    scenario = world.scenario
    sees = {i: scenario.robots[i].sees for i in robots}
    posed = [i for i in robots if sees[i] != "sensors"]  # these see their own pose
    neighbours = {i: tuple(world.neighbour_indices(i)) for i in posed}
    arrays = ("pose", "velocity", "command", "effort", "prop_pose", "prop_velocity")
    seen = {name: np.array(getattr(world, name)) for name in arrays}
    contacts = world.contacts
    if not _sees_all(scenario, robots):
        headed = {*posed}.union(*(neighbours[i] for i in posed if sees[i] == "partial"))
        _hide(seen["pose"][:2], headed.union(*neighbours.values()))
        _hide(seen["pose"][2:], headed)
        _hide(seen["velocity"], posed)
        _hide(seen["command"], robots)
        _hide(seen["effort"], robots)
        seen |= {"prop_pose": np.empty((3, 0)), "prop_velocity": np.empty((3, 0))}
        contacts = contacts[np.isin(contacts["a"], posed) | np.isin(contacts["b"], posed)]
    talks = any(addon.carries_messages for addon in scenario.addons)
    return {
        **seen,
        "iteration": world.iteration,
        "contacts": contacts.tobytes(),
        "neighbours": neighbours,
        "readings": {
            i: {
                each.key: getattr(world.robots[i].sense, each.key)
                for each in scenario.robots[i].sensors
            }
            for i in robots
        },
        "inbox": {i: world.channel.inbox(i) for i in robots} if talks else {},
    }


def _hide(rows: Float, seen: Collection[int]) -> None:
    """Hide the columns of all robots but those that are seen."""
    rows[..., [i for i in range(rows.shape[-1]) if i not in seen]] = np.nan
