"""The world as an isolated law sees it, at the current control step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NoReturn, cast

import numpy as np

from mars2d.core.errors import LawError
from mars2d.core.plane import Outline
from mars2d.record.contact import CONTACT
from mars2d.record.message import Message, as_text
from mars2d.scenario.scenario import Scenario
from mars2d.tournaments.isolation.limits import MB
from mars2d.tournaments.isolation.observation import Briefing, Cast, Seen
from mars2d.world.channel import Channel
from mars2d.world.simulation import Simulation
from mars2d.world.views import VIEWS, Mind, PropView, RobotView, unknown
from mars2d.world.world import World

INSTEAD = {
    "rng": "; there is robot.rng",
    "seed": "; there is robot.rng",
    "history": "; there is robot.memory, to keep what it needs",
}
"""What an isolated law has in place of attributes of a World."""


class Mailbox(Channel):
    """The channel of an isolated law: it keeps messages to and from its robots.

    sent: (sender, content as JSON, receivers) of each message of this control step. arrived: by
    receiver.
    """

    def __init__(self, names: Sequence[str], limit: int) -> None:
        """Take the names of all robots, and the most bytes that may be sent in a control step."""
        self._names = [*names]
        self._indices = {name: i for i, name in enumerate(names)}
        self._limit, self._size = limit, 0
        self.sent: list[tuple[int, str, list[int] | None]] = []
        self.arrived: Mapping[int, tuple[Message, ...]] = {}

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

    def turn(self, arrived: Mapping[int, tuple[Message, ...]]) -> None:
        """Begin the next control step."""
        self.sent, self._size, self.arrived = [], 0, arrived


def _refused(what: str) -> Any:
    """Return a property that raises LawError: it belongs to the robot's own law."""

    def refuse(view: OtherView) -> NoReturn:
        place = f"robot.world.robots[{view._index}].{what}"
        raise LawError(f"{place} is not available: it is another's")

    return property(refuse)


class OtherView(RobotView):
    """Another law's robot, as seen by a law that sees the whole world."""

    def __init__(self, world: Simulation, index: int) -> None:
        self._world, self._index = world, index

    sense = _refused("sense")
    memory = _refused("memory")
    rng = _refused("rng")
    inbox = _refused("inbox")
    neighbours = _refused("neighbours")
    send = _refused("send")


def _rows(name: str, first: int, last: int) -> Any:
    """Return a property for some rows of one of the arrays that are seen."""
    return property(lambda world: getattr(world._seen, name)[first:last])


class MirrorWorld:
    """Stands in for the World in an isolated law's process: the visible part, by the same names.

    robots: views of all robots. mine: the views with which the law is called. Its arrays are read
    only, and new at each control step.
    """

    def __init__(self, briefing: Briefing) -> None:
        """Take the briefing; there are no observations before the first `show`."""
        self._seen: Any = None
        self.scenario: Scenario | Cast = briefing.scenario
        self.obstacles: tuple[Outline, ...] = briefing.obstacles
        described, world = briefing.scenario.robots, cast("Simulation", self)
        self._mailbox: Mailbox | None = None
        if briefing.talks:
            limit = int(briefing.limits.output * MB)
            self._mailbox = Mailbox([str(robot.name) for robot in described], limit)
        names = [str(described[i].name) for i in briefing.robots]
        states = {f"robot {name}": s for name, s in zip(names, briefing.streams, strict=True)}

        def stream(name: str) -> np.random.Generator:
            generator = np.random.PCG64(0)
            generator.state = cast("Any", states[name])
            return np.random.Generator(generator)

        self._minds = {i: Mind(n, stream) for i, n in zip(briefing.robots, names, strict=True)}
        for mind, sensors in zip(self._minds.values(), briefing.sensors, strict=True):
            mind.sense._names.extend(sensors)
        self.mine = [
            VIEWS[sees](world, i, self._minds[i])
            for i, sees in zip(briefing.robots, briefing.sees, strict=True)
        ]
        self.robots = [
            RobotView(world, i, self._minds[i]) if i in self._minds else OtherView(world, i)
            for i in range(len(described))
        ]
        self.props = tuple(PropView(world, i) for i in range(len(briefing.scenario.props)))

    def show(self, seen: Seen) -> None:
        """Take what is seen at a control step."""
        self._seen = seen
        readings = [reading for row in seen.readings.values() for reading in row.values()]
        for each in (*seen, *readings):
            if isinstance(each, np.ndarray):
                each.setflags(write=False)
        for robot, row in seen.readings.items():
            vars(self._minds[robot].sense).update(row)
        if self._mailbox is not None:
            self._mailbox.turn(seen.inbox)

    def letters(self) -> list[tuple[int, str, list[int] | None]]:
        """Return the messages of this control step: (sender, content as JSON, receivers)."""
        return [] if self._mailbox is None else self._mailbox.sent

    def __getattr__(self, name: str) -> NoReturn:
        if not name.startswith("_") and (hasattr(World, name) or hasattr(Simulation, name)):
            there = INSTEAD.get(name, "")
            raise LawError(f"robot.world.{name} is not available to an isolated law{there}")
        unknown(self, "a world", name)

    # -- the interface of World ------------------------------------------------------------------

    pose = _rows("state", 0, 3)
    position = _rows("state", 0, 2)
    velocity = _rows("state", 3, 6)
    command = _rows("state", 6, 8)
    prop_pose = _rows("props", 0, 3)
    prop_velocity = _rows("props", 3, 6)
    iteration = property(lambda world: world._seen.iteration)
    effort = property(lambda world: world._seen.state[8])
    contacts = property(lambda world: np.frombuffer(world._seen.contacts, CONTACT))

    @property
    def view(self) -> MirrorWorld:
        """Itself: it is all that a law may see."""
        return self

    time = property(lambda world: world.iteration * world.sampling_time)
    sampling_time = property(lambda world: world.scenario.sampling_time)
    geometric_center = World.geometric_center
    workspace = property(lambda world: world.scenario.workspace)
    bounds = property(lambda world: world.scenario.bounds)

    def neighbour_indices(self, robot: int) -> Sequence[int]:
        """Return the current neighbours of one of the law's robots, by ``Scenario.neighbours``."""
        return cast("Seen", self._seen).neighbours[robot]

    @property
    def channel(self) -> Mailbox:
        """The robots' channel. Raises LawError if the scenario has no Communication."""
        if self._mailbox is None:
            raise LawError("robots can't talk: add Communication() to Scenario.addons")
        return self._mailbox
