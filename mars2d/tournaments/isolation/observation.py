"""The observations of an isolated law: the part of a scenario and of a world that it may see.

A law's process gets a `Briefing` once, and then a `Seen` at each control step. Neither holds
anything that the law's robots may not see.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError
from mars2d.core.plane import Outline
from mars2d.core.streams import stream
from mars2d.record.message import Message
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.serialize import without_code
from mars2d.tournaments.isolation.limits import Limits

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

Float = NDArray[np.float64]

SHARED_PACKAGES = ("builtins", "numpy", "mars2d")
"""The packages whose objects a law's process can unpickle."""


# -- once ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Cast:
    """The part of a scenario for laws that do not see the whole world.

    robots: the law's own, without their starting poses; of the others, only the names.
    """

    robots: tuple[Robot, ...]
    sampling_time: float
    props: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Briefing:
    """The message that a law's process gets once.

    file: of the law. code: the contents of this file and of those beside it that it imports, by
    path. hidden: the files of other laws. robots: the indices of the law's robots. sees: the sight
    of each of them. scenario: without code, or the visible part of it. obstacles: their outlines,
    if the whole world is seen. streams: the state of each robot's random stream. sensors: each
    robot's, by name. talks: whether the robots can send messages. folder: the current one. chance:
    the seed of Python's and numpy's shared generators, so that a match can be repeated.
    """

    file: Path
    code: Mapping[Path, bytes]
    hidden: tuple[Path, ...]
    robots: tuple[int, ...]
    sees: tuple[str, ...]
    scenario: Scenario | Cast
    obstacles: tuple[Outline, ...]
    streams: tuple[Mapping[str, Any], ...]
    sensors: tuple[tuple[str, ...], ...]
    talks: bool
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
    lawless = [robot.replace(controller=None) for robot in scenario.robots]
    bare, _ = without_code(scenario.replace(robots=lawless))
    mine = [scenario.robots[i] for i in robots]
    whole = any(robot.sees == "full" for robot in mine)
    names = [f"robot {robot.name}" for robot in mine]
    return Briefing(
        file=files[role],
        code=code[role],
        hidden=tuple({path for each in code.values() for path in each} - {*code[role]}),
        robots=tuple(robots),
        sees=tuple(robot.sees for robot in mine),
        scenario=bare if whole else _cast(bare, robots),
        obstacles=tuple(each.outline for each in scenario.surfaces) if whole else (),
        streams=tuple(dict(stream(seed, name).bit_generator.state) for name in names),
        sensors=tuple(tuple(sensor.key for sensor in robot.sensors) for robot in mine),
        talks=any(addon.carries_messages for addon in scenario.addons),
        limits=limits,
        folder=os.getcwd(),  # noqa: PTH109 - as text
        chance=int(stream(seed, f"law of {role}").integers(2**32)),
    )


def _cast(bare: Scenario, robots: Sequence[int]) -> Cast:
    somewhere = (0.0, 0.0, 0.0)
    known = [
        robot.replace(pose=somewhere) if i in robots else Robot(name=robot.name)
        for i, robot in enumerate(bare.robots)
    ]
    return Cast(tuple(known), bare.sampling_time)


# -- at each control step --------------------------------------------------------------------------


class Seen(NamedTuple):
    """What a law sees at a control step; NaN is what it may not see.

    state: (9, n), of all robots: pose (3), velocity (3), command (2), effort. props: (6, p), pose
    and velocity. contacts: the bytes of their rows. neighbours, readings, inbox: by the indices of
    the law's robots; readings by the sensors' names.
    """

    iteration: int
    state: Float
    props: Float
    contacts: bytes
    neighbours: Mapping[int, Sequence[int]]
    readings: Mapping[int, Mapping[str, Any]]
    inbox: Mapping[int, tuple[Message, ...]]


def look(world: Simulation, briefing: Briefing) -> Seen:
    """Return what the law of a briefing sees of a world now. Errors of sensors pass through."""
    mine, whole = briefing.robots, "full" in briefing.sees
    seeing = dict(zip(mine, briefing.sees, strict=True))
    posed = [i for i, sees in seeing.items() if sees != "sensors"]  # these see their own pose
    neighbours = {robot: tuple(world.neighbour_indices(robot)) for robot in posed}
    state = np.empty((9, len(world.effort)))
    state[:3], state[3:6] = world.pose, world.velocity
    state[6:8], state[8] = world.command, world.effort
    props, contacts = np.empty((6, 0)), world.contacts
    if whole:
        props = np.vstack([world.prop_pose, world.prop_velocity])
    else:
        headed = {*posed}
        headed.update(*(near for i, near in neighbours.items() if seeing[i] == "partial"))
        _hide(state[:2], headed.union(*neighbours.values()))
        _hide(state[2:3], headed)
        _hide(state[3:6], posed)
        _hide(state[6:], mine)
        if len(contacts):
            contacts = contacts[np.isin(contacts["a"], posed) | np.isin(contacts["b"], posed)]
    return Seen(
        iteration=world.iteration,
        state=state,
        props=props,
        contacts=contacts.tobytes(),
        neighbours=neighbours,
        readings={
            robot: {name: _reading(world, robot, name) for name in names}
            for robot, names in zip(mine, briefing.sensors, strict=True)
            if names
        },
        inbox={i: world.channel.inbox(i) for i in mine} if briefing.talks else {},
    )


def _hide(rows: Float, seen: Collection[int]) -> None:
    """Hide the columns of all robots but those that are seen."""
    rows[:, [i for i in range(rows.shape[1]) if i not in seen]] = np.nan


def _reading(world: Simulation, robot: int, name: str) -> Any:
    """Return a reading if a law's process can unpickle it; raise LawError if not."""
    reading = getattr(world.robots[robot].sense, name)
    if foreign := _foreign(reading):
        raise LawError(
            f"sensor {name!r} reads a {foreign}, which can't be handed to a law in another "
            "process: expected numbers, text, arrays, or lists, tuples and dicts of these"
        )
    return reading


def _foreign(reading: Any) -> str:
    """Return the name of a class in a reading that a law's process does not know, or ""."""
    kind = type(reading)
    if kind in (list, tuple):
        return next(filter(None, map(_foreign, reading)), "")
    if kind is dict:
        return _foreign([*reading, *reading.values()])
    other = reading.dtype.hasobject if isinstance(reading, np.ndarray) else callable(reading)
    known = kind.__module__.partition(".")[0] in SHARED_PACKAGES
    return kind.__name__ if other or not known else ""
