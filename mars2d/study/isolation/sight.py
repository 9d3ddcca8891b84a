"""What the robots of a role may see of a world at a control step, as the bytes of a frame."""

from __future__ import annotations

import pickle
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError
from mars2d.record.message import Message
from mars2d.study.isolation.briefing import Briefing
from mars2d.study.isolation.frames import HEAD, STEP, STEP_HEAD, VELOCITIES, Layout

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

__all__ = ["News", "Sight"]

Mask = NDArray[np.bool_]

KNOWN = ("builtins", "numpy", "mars2d")
"""The packages whose objects a law's process knows as well."""


class News(NamedTuple):
    """What is not the same in size at each control step, by the robots' indices.

    neighbours and readings are those that have changed; inbox are the messages that have arrived.
    """

    neighbours: Mapping[int, tuple[int, ...]]
    readings: Mapping[int, Mapping[str, Any]]
    inbox: Mapping[int, tuple[Message, ...]]


class Sight:
    """Makes the frames for the law of one role; only what it may see is in them.

    velocities: whether they are in them, which takes time to work out.
    """

    def __init__(self, briefing: Briefing, robots: int, props: int) -> None:
        """Take what its process was told, and how many robots and props there are in all."""
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
        self._posed = [i for i, sees in seeing if sees != "sensors"]  # who know their own pose
        self._heading = {i for i, sees in seeing if sees == "partial"}  # and others' headings
        self._mine = self._mask(3, briefing.robots)
        self._moving = self._mask(3, self._posed)
        self._placed = self._moving
        self._neighbours: dict[int, Sequence[int]] = {}
        self._readings: dict[tuple[int, str], Any] = {}
        self._senses = any(briefing.sensors)
        self.velocities = False

    def _mask(self, rows: int, robots: Iterable[int]) -> Mask:
        """Return which numbers (rows, n) are those of some robots, or of all if all is seen."""
        mask = np.full((rows, len(self._parts["effort"])), self._whole)
        mask[:, [*robots]] = True
        return mask

    def frame(self, world: Simulation) -> bytes | memoryview:
        """Return the frame of the present control step. Raises what a sensor raises that is read.

        It may be written over by the next one.
        """
        changed = self._changed_neighbours(world)
        if changed and not self._whole:
            self._look_again()
        self._fill(world)
        readings = self._changed_readings(world) if self._senses else {}
        inbox = self._inbox(world) if self._briefing.talks else {}
        if changed or readings or inbox:
            return self._framed(world, pickle.dumps((changed, readings, inbox), 5))
        return self._framed(world, b"")

    def again(self, world: Simulation) -> bytes | memoryview:
        """Return the frame of the same control step again, without what it is told for once."""
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

    def _look_again(self) -> None:
        """See others, whose neighbours have changed; forget those that are seen no more."""
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
                changed.setdefault(robot, {})[name] = _known(name, reading)
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


def _known(name: str, reading: Any) -> Any:
    """Return a reading, if a law's process can make something of it. Raises LawError if not."""
    kind = type(reading)
    parts: Iterable[Any] = ()
    if kind in (list, tuple):
        parts = reading
    elif kind is dict:
        parts = (*reading, *reading.values())
    for part in parts:
        _known(name, part)
    foreign = reading.dtype.hasobject if isinstance(reading, np.ndarray) else callable(reading)
    if kind.__module__.partition(".")[0] in KNOWN and not foreign:
        return reading
    raise LawError(
        f"sensor {name!r} reads a {kind.__name__}, which can't be handed to a law in another "
        "process: expected numbers, text, arrays, or lists, tuples and dicts of these"
    )
