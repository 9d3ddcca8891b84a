"""The world as an isolated law sees it, at the current control step."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn, cast

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError
from mars2d.core.plane import Outline
from mars2d.record.contact import CONTACT
from mars2d.record.message import Message, as_text
from mars2d.scenario.scenario import Scenario
from mars2d.study.isolation.observation import Briefing, Cast, News
from mars2d.study.isolation.protocol import STEP, STEP_HEAD, Layout
from mars2d.world.channel import Channel
from mars2d.world.views import VIEWS, Mind, PropView, RobotView, unknown

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

Float = NDArray[np.float64]

REFUSED = {
    "rng": "robot.rng",
    "stream": "robot.rng",
    "seed": "robot.rng",
    "history": "robot.memory, to keep what it needs",
    **dict.fromkeys(
        (
            "addons", "surroundings", "operator", "recorder", "record", "frame", "step", "stop",
            "hold", "observe", "follow", "change", "rebuild", "break_off", "control", "driven",
            "motion", "over", "over_message", "finished", "watch", "filename",
        ),
        "",
    ),
}  # fmt: skip
"""The attributes of a World that a MirrorWorld lacks, with the substitute if there is one."""

NO_NEWS = News({}, {}, {})
NO_CONTACTS = np.empty(0, dtype=CONTACT)


class Mailbox(Channel):
    """The channel of an isolated law: it keeps messages to and from its robots."""

    def __init__(self, names: Sequence[str], limit: int) -> None:
        """Take the names of all robots, and the most bytes that may be sent in a control step."""
        self._names = [*names]
        self._indices = {name: i for i, name in enumerate(names)}
        self._limit, self._size = limit, 0
        self._outbox: list[tuple[int, str, list[int] | None]] = []
        self.arrived: Mapping[int, tuple[Message, ...]] = {}

    def inbox(self, robot: int) -> tuple[Message, ...]:
        """Return the messages that have arrived for a robot at the current control step."""
        return self.arrived.get(robot, ())

    def send(self, sender: int, content: Any, to: Any) -> None:
        """Keep a message from a robot. Raises LawError as the world's channel does."""
        text = as_text(content)
        receivers = None if to is None else self._receivers(sender, to).tolist()
        self._size += 100 + len(text) + 8 * len(receivers or ())
        if self._size > self._limit:
            raise LawError(f"robot.send: more than {self._limit} bytes in one control step")
        self._outbox.append((sender, text, receivers))

    def taken(self) -> bytes:
        """Return and forget sent messages, [[sender, content, receivers], ...] as JSON, or b''."""
        sent, self._outbox, self._size = self._outbox, [], 0
        return json.dumps(sent).encode() if sent else b""


class _Streams:
    """The random streams of robots, from states that the match computed from its seed."""

    def __init__(self, states: Mapping[str, Mapping[str, Any]]) -> None:
        self._states = states

    def stream(self, name: str) -> np.random.Generator:
        generator = np.random.PCG64(0)
        generator.state = cast("Any", self._states[name])
        return np.random.Generator(generator)


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


class MirrorWorld:
    """Stands in for the World in an isolated law's process: the visible part, by the same names.

    robots: views of all robots. mine: the views with which the law is called.
    """

    def __init__(self, briefing: Briefing, velocities: Callable[[], tuple[bytes, bytes]]) -> None:
        """Take the briefing; there are no observations before the first `show`.

        velocities: requests the frame of the current control step with velocities.
        """
        self._ask_velocities = velocities
        self.scenario: Scenario | Cast = briefing.scenario
        self.obstacles: tuple[Outline, ...] = briefing.obstacles
        self.iteration = -1
        described = briefing.scenario.robots
        props = len(briefing.scenario.props)
        self._layout = Layout(len(described), props)
        self._mailbox: Mailbox | None = None
        if briefing.talks:
            limit = int(briefing.limits.output * 1e6)
            self._mailbox = Mailbox([str(robot.name) for robot in described], limit)
        self._neighbours: dict[int, Sequence[int]] = {}
        world = cast("Simulation", self)
        names = [str(described[i].name) for i in briefing.robots]
        keys = [f"robot {name}" for name in names]
        stream = _Streams(dict(zip(keys, briefing.streams, strict=True))).stream
        self._minds = {
            i: Mind(name, stream) for i, name in zip(briefing.robots, names, strict=True)
        }
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
        self.props = tuple(PropView(world, i) for i in range(props))

    def show(self, kind: bytes, body: bytes) -> None:
        """Take the observations of a control step from its frame."""
        self.iteration, contacts, more = STEP_HEAD.unpack_from(body)
        self._seen: dict[str, Float] = {}
        self._body, self._with_velocities = body, kind != STEP
        if len(body) == (self._layout.moving if self._with_velocities else self._layout.still):
            self._take_news(b"", b"")
            return
        end = len(body) - more
        self._take_news(body[end - contacts : end], body[end:])

    def _take_news(self, contacts: bytes, more: bytes) -> None:
        self._contacts = np.frombuffer(contacts, CONTACT) if contacts else NO_CONTACTS
        news = News(*pickle.loads(more)) if more else NO_NEWS
        self._neighbours.update(news.neighbours)
        for robot, readings in news.readings.items():
            for name, reading in readings.items():
                if isinstance(reading, np.ndarray):
                    reading.setflags(write=False)
                vars(self._minds[robot].sense)[name] = reading
        if self._mailbox is not None:
            self._mailbox.arrived = news.inbox

    def _part(self, name: str) -> Float:
        if name not in self._seen:
            self._seen[name] = self._layout.part(self._body, name)
        return self._seen[name]

    def _moving(self, name: str) -> Float:
        if not self._with_velocities:
            _, body = self._ask_velocities()
            self._body, self._with_velocities = body, True
        return self._part(name)

    def taken_letters(self) -> bytes:
        """Return the messages sent since the last call; see `Mailbox.taken`."""
        return b"" if self._mailbox is None else self._mailbox.taken()

    def __getattr__(self, name: str) -> NoReturn:
        if name in REFUSED:
            there = f"; there is {REFUSED[name]}" if REFUSED[name] else ""
            raise LawError(f"robot.world.{name} is not available to an isolated law{there}")
        unknown(self, "a world", name)

    # -- the interface of World ------------------------------------------------------------------

    @property
    def view(self) -> MirrorWorld:
        """Itself: it is all that a law may see."""
        return self

    @property
    def time(self) -> float:
        """The simulated time, seconds: iteration x sampling time."""
        return self.iteration * self.scenario.sampling_time

    @property
    def sampling_time(self) -> float:
        """The time from one command to the next, seconds."""
        return self.scenario.sampling_time

    @property
    def pose(self) -> Float:
        """The poses (3, n): x, y [m], theta [rad, not wrapped]. Read only; new at each step."""
        return self._part("pose")

    @property
    def position(self) -> Float:
        """The positions (2, n): x, y [m]. Read only; new at each step."""
        return self._part("pose")[:2]

    @property
    def velocity(self) -> Float:
        """The robots' velocities (3, n) at this instant: x', y' [m/s], theta' [rad/s]."""
        return self._moving("velocity")

    @property
    def prop_pose(self) -> Float:
        """The poses of the props' centres of mass (3, p): x, y [m], theta [rad]. Read only."""
        return self._part("prop_pose")

    @property
    def prop_velocity(self) -> Float:
        """The velocities of the props (3, p): x', y' [m/s], theta' [rad/s]."""
        return self._moving("prop_velocity")

    @property
    def effort(self) -> Float:
        """The share of its bounds that each drive used in the last step, (n,), 0 to 1."""
        return self._part("effort")

    @property
    def geometric_center(self) -> Float:
        """The geometric centres (2, n) [m], `Robot.center_offset` behind those of rotation."""
        offset = np.array([robot.center_offset for robot in self.scenario.robots])
        x, y, theta = self.pose
        return np.array([x - offset * np.cos(theta), y - offset * np.sin(theta)])

    @property
    def command(self) -> Float:
        """The last command (2, n) after saturation; zeros at first. Read only."""
        return self._part("command")

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts since the last step, rows of dtype `mars2d.record.CONTACT`."""
        return self._contacts

    @property
    def workspace(self) -> Outline | None:
        """The polygon in which the robots move, or None."""
        return cast("Scenario", self.scenario).workspace

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) of the workspace, metres."""
        return cast("Scenario", self.scenario).bounds

    def neighbour_indices(self, robot: int) -> Sequence[int]:
        """Return the current neighbours of one of the law's robots, by ``Scenario.neighbours``."""
        return self._neighbours[robot]

    @property
    def channel(self) -> Mailbox:
        """The robots' channel. Raises LawError if the scenario has no Communication."""
        if self._mailbox is None:
            raise LawError("robots can't talk: add Communication() to Scenario.addons")
        return self._mailbox
