"""The world as an isolated law sees it: what it may see of it, at the present control step."""

from __future__ import annotations

import json
import pickle
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NoReturn, cast

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError, UnknownNameError, nearest
from mars2d.core.plane import Outline
from mars2d.record.contact import CONTACT
from mars2d.record.message import Message, as_text
from mars2d.scenario.scenario import Scenario
from mars2d.study.isolation.briefing import Briefing, Cast
from mars2d.study.isolation.frames import STEP, STEP_HEAD, Layout
from mars2d.study.isolation.sight import News
from mars2d.world.channel import Channel
from mars2d.world.views import VIEWS, Mind, PropView, RobotView

if TYPE_CHECKING:
    from mars2d.world.interfaces import Seen

__all__ = ["Letters", "Mirror"]

Float = NDArray[np.float64]

REFUSED = {
    "rng": "robot.rng",
    "stream": "robot.rng",
    "seed": "robot.rng",
    "history": "robot.memory, to keep what it needs",
    **dict.fromkeys(
        (
            "addons", "surroundings", "hands", "recorder", "record", "frame", "step", "stop",
            "hold", "observe", "follow", "change", "rebuild", "break_off", "control", "driven",
            "motion", "over", "over_message", "finished", "watch", "filename",
        ),
        "",
    ),
}  # fmt: skip
"""What a World has and a Mirror has not, with what there is in its place."""


NO_NEWS = News({}, {}, {})
NO_CONTACTS = np.empty(0, dtype=CONTACT)


class Letters(Channel):
    """Keeps the messages that an isolated law's robots send and get, for the true channel."""

    def __init__(self, names: Sequence[str], limit: int) -> None:
        """Take the names of all robots, and how many bytes may be sent in one control step."""
        self._names = [*names]
        self._indices = {name: i for i, name in enumerate(names)}
        self._limit, self._size = limit, 0
        self._outbox: list[tuple[int, str, list[int] | None]] = []
        self.arrived: Mapping[int, tuple[Message, ...]] = {}

    def inbox(self, robot: int) -> tuple[Message, ...]:
        """Return the messages that have arrived for a robot at the present control step."""
        return self.arrived.get(robot, ())

    def send(self, sender: int, content: Any, to: Any) -> None:
        """Take a message of a robot. Raises LawError as the true channel does."""
        text = as_text(content)
        receivers = None if to is None else self._receivers(sender, to).tolist()
        self._size += 100 + len(text) + 8 * len(receivers or ())
        if self._size > self._limit:
            raise LawError(f"robot.send: more than {self._limit} bytes in one control step")
        self._outbox.append((sender, text, receivers))

    def taken(self) -> bytes:
        """Return what was sent as JSON, [[sender, content as JSON, receivers], ...], or nothing."""
        sent, self._outbox, self._size = self._outbox, [], 0
        return json.dumps(sent).encode() if sent else b""


class _Streams:
    """The random streams of robots: their states were worked out where the seed is known."""

    def __init__(self, states: Mapping[str, Mapping[str, Any]]) -> None:
        self._states = states

    def stream(self, name: str) -> np.random.Generator:
        generator = np.random.PCG64(0)
        generator.state = cast("Any", self._states[name])
        return np.random.Generator(generator)


class OtherView(RobotView):
    """A robot of another law, as one sees it that sees the whole world."""

    def __init__(self, world: Seen, index: int) -> None:
        self._world, self._index = world, index

    def _refuse(self, what: str) -> NoReturn:
        raise LawError(
            f"robot.world.robots[{self._index}].{what} is not available: it is another's"
        )

    @property
    def sense(self) -> NoReturn:  # type: ignore[override]
        """Refuse: it is the other's."""
        self._refuse("sense")

    @property
    def memory(self) -> NoReturn:  # type: ignore[override]
        """Refuse: it is the other's."""
        self._refuse("memory")

    @property
    def rng(self) -> NoReturn:
        """Refuse: it is the other's."""
        self._refuse("rng")

    @property
    def inbox(self) -> NoReturn:
        """Refuse: it is the other's."""
        self._refuse("inbox")

    @property
    def neighbours(self) -> NoReturn:
        """Refuse: it is the other's."""
        self._refuse("neighbours")

    def send(self, content: Any, to: Any = None) -> None:  # noqa: ARG002 - as the other's
        """Refuse: only the other may speak for itself."""
        self._refuse("send")


class Mirror:
    """What a law in a process of its own is shown of a World, under the same names.

    robots: views of all, if the whole world is seen, else of its own at their indices. mine: the
    views that the law is called with.
    """

    def __init__(self, briefing: Briefing, velocities: Callable[[], tuple[bytes, bytes]]) -> None:
        """Take what was told; nothing is seen before the first `show`.

        velocities: asks for the frame of the present control step with velocities.
        """
        self._ask_velocities = velocities
        self.scenario: Scenario | Cast = briefing.scenario
        self.obstacles: tuple[Outline, ...] = briefing.obstacles
        self.iteration = -1
        described = briefing.scenario.robots
        props = len(briefing.scenario.props)
        self._layout = Layout(len(described), props)
        self._letters: Letters | None = None
        if briefing.talks:
            limit = int(briefing.limits.output * 1e6)
            self._letters = Letters([str(robot.name) for robot in described], limit)
        self._neighbours: dict[int, Sequence[int]] = {}
        world: Seen = self
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
        """Take what is seen at a control step from its frame."""
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
        if self._letters is not None:
            self._letters.arrived = news.inbox

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
        """Return the messages that were sent since the last call, see `Letters.taken`."""
        return b"" if self._letters is None else self._letters.taken()

    def __getattr__(self, name: str) -> NoReturn:
        if name in REFUSED:
            instead = f"; there is {REFUSED[name]}" if REFUSED[name] else ""
            raise LawError(f"robot.world.{name} is not available to an isolated law{instead}")
        known = [item for item in dir(self) if not item.startswith("_")]
        raise UnknownNameError(f"a world has no {name!r}{nearest(name, known, most=30)}")

    # -- what views and laws ask, as of a World --------------------------------------------------

    @property
    def view(self) -> Mirror:
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
        """The largest share of its bounds that each drive used in the last step, (n,), 0 to 1."""
        return self._part("effort")

    @property
    def geometric_center(self) -> Float:
        """The geometric centres (2, n) [m]: `Robot.center_offset` behind those of rotation."""
        offset = np.array([robot.center_offset for robot in self.scenario.robots])
        x, y, theta = self.pose
        return np.array([x - offset * np.cos(theta), y - offset * np.sin(theta)])

    @property
    def command(self) -> Float:
        """The last command (2, n) that was issued, after saturation; zeros at first. Read only."""
        return self._part("command")

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts since the last step, one row a pair, of dtype `mars2d.record.CONTACT`."""
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
        """Return whom ``Scenario.neighbours`` makes neighbours of one of its robots now."""
        return self._neighbours[robot]

    @property
    def channel(self) -> Letters:
        """What carries the robots' messages. Raises LawError if they have nothing to talk by."""
        if self._letters is None:
            raise LawError("robots can't talk: add Communication() to Scenario.addons")
        return self._letters
