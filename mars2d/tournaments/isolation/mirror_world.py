"""The world as an isolated law sees it, at the current control step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any, cast

import numpy as np

from mars2d.core.errors import LawError
from mars2d.core.plane import Outline
from mars2d.record.contact import CONTACT
from mars2d.record.message import Message, as_text
from mars2d.tournaments.isolation.limits import MB
from mars2d.tournaments.isolation.observation import Briefing
from mars2d.world.channel import Channel
from mars2d.world.simulation import Simulation
from mars2d.world.team_view import WorldView
from mars2d.world.views import VIEWS, Mind, PropView, RobotView, unseen

INSTEAD = {
    "rng": "; there is robot.rng",
    "seed": "; there is robot.rng",
    "history": "; there is robot.memory, to keep what it needs",
}
"""What an isolated law has in place of attributes of a World."""

Letter = tuple[int, str, list[int] | None]
"""A message: its sender, its content as JSON, its receivers, or None for all in reach."""


class Mailbox(Channel):
    """The channel of an isolated law in a control step: messages to and from its robots.

    arrived: by receiver. sent: those of this control step.
    """

    def __init__(
        self, names: Sequence[str], limit: int, arrived: Mapping[int, tuple[Message, ...]]
    ) -> None:
        """Take the names of all robots, the most bytes to be sent, and what has arrived."""
        self._names = [*names]
        self._limit, self._size, self.arrived = limit, 0, arrived
        self.sent: list[Letter] = []

    def inbox(self, robot: int) -> tuple[Message, ...]:
        """Return the messages that have arrived for a robot at the current control step."""
        return self.arrived[robot]

    def send(self, sender: int, content: Any, to: Any) -> None:
        """Keep a message from a robot. Raises LawError as the world's channel does."""
        text = as_text(content)
        receivers = None if to is None else self._receivers(sender, to).tolist()
        self._size += 100 + len(text) + 8 * len(receivers or ())
        if self._size > self._limit:
            raise LawError(f"robot.send: more than {self._limit} bytes in one control step")
        self.sent.append((sender, text, receivers))


class OtherView(RobotView):
    """Another law's robot, as seen by a law that sees the whole world."""

    def __init__(self, world: Simulation, index: int) -> None:
        self._world, self._index = world, index

    sense, memory, rng, inbox, neighbours, send = (
        unseen(f"another robot's {name}", "robots of other laws from outside")
        for name in ("sense", "memory", "rng", "inbox", "neighbours", "send")
    )


class MirrorView(WorldView):
    """The world of a law that sees all of it: what a `MirrorWorld` knows."""

    @property
    def obstacles(self) -> tuple[Outline, ...]:  # type: ignore[override]
        """The outlines of all obstacles."""
        return tuple(surface.outline for surface in self.scenario.surfaces)


class MirrorWorld:
    """Stands in for a Simulation in an isolated law's process: the visible part, by the same names.

    robots: views of all robots. mine: the views with which the law is called. mailbox: of their
    messages. Its arrays are read only, and new at each control step.
    """

    def __init__(self, briefing: Briefing) -> None:
        """Take the briefing; there are no observations before the first `show`."""
        self.scenario = briefing.scenario
        described, world = self.scenario.robots, cast("Simulation", self)
        names = [str(robot.name) for robot in described]
        self._mailbox_of = partial(Mailbox, names, int(briefing.limits.output * MB))

        def stream(name: str) -> np.random.Generator:
            generator = np.random.PCG64(0)
            generator.state = briefing.streams[name]
            return np.random.Generator(generator)

        self._minds = {i: Mind(names[i], stream) for i in briefing.robots}
        self.mine = [VIEWS[described[i].sees](world, i, mind) for i, mind in self._minds.items()]
        self.robots = [
            RobotView(world, i, self._minds[i]) if i in self._minds else OtherView(world, i)
            for i in range(len(described))
        ]
        self.props = tuple(PropView(world, i) for i in range(len(self.scenario.props)))
        self.sampling_time = self.scenario.sampling_time
        self.view = MirrorView(world)

    def show(self, seen: dict[str, Any]) -> None:
        """Take what is seen at a control step, see `look`."""
        vars(self).update(seen)
        self.time = self.iteration * self.sampling_time
        self.position = self.pose[:2]
        self.contacts = np.frombuffer(seen["contacts"], CONTACT)
        readings = [reading for row in self.readings.values() for reading in row.values()]
        for each in (*vars(self).values(), *readings):
            if isinstance(each, np.ndarray):
                each.setflags(write=False)
        for robot, row in self.readings.items():
            sense = self._minds[robot].sense
            vars(sense).update(row)
            sense._names = [*row]
        self.mailbox = self._mailbox_of(self.inbox)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        there = INSTEAD.get(name, "")
        raise LawError(f"robot.world.{name} is not available to an isolated law{there}")

    def neighbour_indices(self, robot: int) -> Sequence[int]:
        """Return the current neighbours of one of the law's robots, by ``Scenario.neighbours``."""
        return cast("Sequence[int]", self.neighbours[robot])

    @property
    def channel(self) -> Mailbox:
        """The robots' channel. Raises LawError if the scenario has no Communication."""
        if not self.mailbox.arrived:
            raise LawError("robots can't talk: add Communication() to Scenario.addons")
        return self.mailbox
