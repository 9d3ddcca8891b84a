"""The observations of an isolated law: the part of a scenario and of a world that it may see.

A law's process gets a `Briefing` once, and then a frame at each control step. Neither holds
anything that the law's robots may not see.
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Iterable, Mapping, Sequence
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
from mars2d.study.isolation.limits import Limits
from mars2d.study.isolation.protocol import HEAD, STEP, STEP_HEAD, VELOCITIES, Layout

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

Mask = NDArray[np.bool_]

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

    robots: the indices of the law's robots. sees: the sight of each of them. scenario: without
    code, or the visible part of it. obstacles: their outlines, if the whole world is seen. streams:
    the state of each robot's random stream. sensors: each robot's, by name. talks: whether the
    robots can send messages. folder: the current one. chance: the seed of Python's and numpy's
    shared generators, so that a match can be repeated.
    """

    file: Path
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
    scenario: Scenario, laws: Mapping[str, tuple[Path, Sequence[int]]], seed: int, limits: Limits
) -> dict[str, Briefing]:
    """Return the briefing of each role; `laws` holds its file and the indices of its robots.

    A briefing holds only what the law may see. The seed is not part of it.
    """
    lawless = [robot.replace(controller=None) for robot in scenario.robots]
    bare, _ = without_code(scenario.replace(robots=lawless))
    return {
        role: _briefing(scenario, bare, file, robots, stream(seed, f"law of {role}"), seed, limits)
        for role, (file, robots) in laws.items()
    }


def _briefing(
    scenario: Scenario,
    bare: Scenario,
    file: Path,
    robots: Sequence[int],
    chance: np.random.Generator,
    seed: int,
    limits: Limits,
) -> Briefing:
    mine = [scenario.robots[i] for i in robots]
    whole = any(robot.sees == "full" for robot in mine)
    names = [f"robot {robot.name}" for robot in mine]
    return Briefing(
        file=file,
        robots=tuple(robots),
        sees=tuple(robot.sees for robot in mine),
        scenario=bare if whole else _cast(bare, robots),
        obstacles=tuple(each.outline for each in scenario.surfaces) if whole else (),
        streams=tuple(dict(stream(seed, name).bit_generator.state) for name in names),
        sensors=tuple(tuple(sensor.key for sensor in robot.sensors) for robot in mine),
        talks=any(addon.carries_messages for addon in scenario.addons),
        limits=limits,
        folder=os.getcwd(),  # noqa: PTH109 - as text
        chance=int(chance.integers(2**32)),
    )


def _cast(bare: Scenario, robots: Sequence[int]) -> Cast:
    somewhere = (0.0, 0.0, 0.0)
    known = [
        robot.replace(pose=somewhere) if i in robots else Robot(name=robot.name)
        for i, robot in enumerate(bare.robots)
    ]
    return Cast(tuple(known), bare.sampling_time)


# -- at each control step --------------------------------------------------------------------------


class News(NamedTuple):
    """The observations of varying size at a control step, by the robots' indices.

    neighbours, readings: those that have changed. inbox: messages that have arrived.
    """

    neighbours: Mapping[int, tuple[int, ...]]
    readings: Mapping[int, Mapping[str, Any]]
    inbox: Mapping[int, tuple[Message, ...]]


class Observer:
    """Makes the frames for the law of one role, from the visible part of a world.

    velocities: whether frames include them; they take time to compute.
    """

    def __init__(self, briefing: Briefing, robots: int, props: int) -> None:
        """Take the law's briefing, and the numbers of all robots and props."""
        self._briefing = briefing
        self._whole = "full" in briefing.sees
        self._layout = Layout(robots, props)
        self._buffer = bytearray(HEAD.size + self._layout.moving)
        body = memoryview(self._buffer)[HEAD.size :]
        names = ("pose", "command", "effort", "prop_pose", "velocity", "prop_velocity")
        self._parts = {name: self._layout.part(body, name) for name in names}
        for part in self._parts.values():
            part.fill(np.nan)
        seeing = list(zip(briefing.robots, briefing.sees, strict=True))
        self._posed = [i for i, sees in seeing if sees != "sensors"]  # these see their own pose
        self._heading = {
            i for i, sees in seeing if sees == "partial"
        }  # and their neighbours' headings
        self._mine = self._mask(3, briefing.robots)
        self._moving = self._mask(3, self._posed)
        self._placed = self._moving
        self._neighbours: dict[int, Sequence[int]] = {}
        self._readings: dict[tuple[int, str], Any] = {}
        self._senses = any(briefing.sensors)
        self.velocities = False

    def _mask(self, rows: int, robots: Iterable[int]) -> Mask:
        """Return a mask (rows, n) of some robots' columns, or of all if the whole world is seen."""
        mask = np.full((rows, len(self._parts["effort"])), self._whole)
        mask[:, [*robots]] = True
        return mask

    def frame(self, world: Simulation) -> bytes | memoryview:
        """Return the frame of the current control step; the next call may overwrite it.

        Errors of sensors that are read pass through.
        """
        changed = self._changed_neighbours(world)
        if changed and not self._whole:
            self._update_masks()
        self._fill(world)
        readings = self._changed_readings(world) if self._senses else {}
        inbox = self._inbox(world) if self._briefing.talks else {}
        if changed or readings or inbox:
            return self._framed(world, pickle.dumps((changed, readings, inbox), 5))
        return self._framed(world, b"")

    def again(self, world: Simulation) -> bytes | memoryview:
        """Return the frame of the same control step again, without its `News`."""
        self._fill(world)
        return self._framed(world, b"")

    def _framed(self, world: Simulation, more: bytes) -> bytes | memoryview:
        contacts = self._contacts(world)
        length = self._layout.moving if self.velocities else self._layout.still
        kind = VELOCITIES if self.velocities else STEP
        HEAD.pack_into(self._buffer, 0, length + len(contacts) + len(more), kind)
        STEP_HEAD.pack_into(self._buffer, HEAD.size, world.iteration, len(contacts), len(more))
        frame = memoryview(self._buffer)[: HEAD.size + length]
        return b"".join((frame, contacts, more)) if contacts or more else frame

    def _fill(self, world: Simulation) -> None:
        parts, mine = self._parts, self._mine
        np.copyto(parts["pose"], world.pose, where=self._placed)
        np.copyto(parts["command"], world.command, where=mine[:2])
        np.copyto(parts["effort"], world.effort, where=mine[0])
        if self.velocities:
            np.copyto(parts["velocity"], world.velocity, where=self._moving)
        if self._whole and len(world.props):
            parts["prop_pose"][...] = world.prop_pose
            if self.velocities:
                parts["prop_velocity"][...] = world.prop_velocity

    def _update_masks(self) -> None:
        """Update which robots are seen after neighbours changed, and clear the poses of others."""
        placed, headed = {*self._posed}, {*self._posed}
        for robot in self._posed:
            placed.update(self._neighbours[robot])
            if robot in self._heading:
                headed.update(self._neighbours[robot])
        self._placed = self._mask(3, placed)
        self._placed[2] = self._mask(1, headed)
        self._parts["pose"].fill(np.nan)

    def _changed_neighbours(self, world: Simulation) -> dict[int, tuple[int, ...]]:
        changed: dict[int, tuple[int, ...]] = {}
        if self._neighbours and world.scenario.neighbours.fixed:
            return changed
        for robot in self._posed:
            found, known = world.neighbour_indices(robot), self._neighbours.get(robot)
            if found is not known:
                self._neighbours[robot] = found
                if known is None or tuple(found) != tuple(known):
                    changed[robot] = tuple(found)
        return changed

    def _changed_readings(self, world: Simulation) -> dict[int, dict[str, Any]]:
        changed: dict[int, dict[str, Any]] = {}
        for robot, names in zip(self._briefing.robots, self._briefing.sensors, strict=True):
            for name in names:
                reading = getattr(world.robots[robot].sense, name)
                kept = isinstance(reading, np.ndarray) and not reading.flags.writeable
                if kept and self._readings.get((robot, name)) is reading:
                    continue
                self._readings[robot, name] = reading
                changed.setdefault(robot, {})[name] = _transferable(name, reading)
        return changed

    def _inbox(self, world: Simulation) -> dict[int, tuple[Message, ...]]:
        arrived = {robot: world.channel.inbox(robot) for robot in self._briefing.robots}
        return {robot: messages for robot, messages in arrived.items() if messages}

    def _contacts(self, world: Simulation) -> bytes:
        rows = world.contacts
        if not len(rows) or not self._posed:
            return b""
        if not self._whole:
            rows = rows[np.isin(rows["a"], self._posed) | np.isin(rows["b"], self._posed)]
        return rows.tobytes()


def _transferable(name: str, reading: Any) -> Any:
    """Return a reading if a law's process can unpickle it; raise LawError if not."""
    kind = type(reading)
    parts: Iterable[Any] = ()
    if kind in (list, tuple):
        parts = reading
    elif kind is dict:
        parts = (*reading, *reading.values())
    for part in parts:
        _transferable(name, part)
    foreign = reading.dtype.hasobject if isinstance(reading, np.ndarray) else callable(reading)
    if kind.__module__.partition(".")[0] in SHARED_PACKAGES and not foreign:
        return reading
    raise LawError(
        f"sensor {name!r} reads a {kind.__name__}, which can't be handed to a law in another "
        "process: expected numbers, text, arrays, or lists, tuples and dicts of these"
    )
