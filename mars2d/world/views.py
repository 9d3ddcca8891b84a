"""The views of robots, neighbours and props that laws are given, by their information."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.drives.base import Drive
from mars2d.core.arrays import locked
from mars2d.core.errors import CERTAIN, LawError, UnknownNameError, likely, nearest, shown
from mars2d.core.through import through
from mars2d.core.words import instead
from mars2d.record.message import Message
from mars2d.sensors.sensing import Sense

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

Float = NDArray[np.float64]


class _Unseen(property):
    """An attribute that a law may not read."""


def unseen(what: str, sees: str, instead: str = "") -> Any:
    """Return a property that refuses a law that sees no more than `sees`."""

    def refuse(_: object) -> NoReturn:
        hint = f"; there is {instead}" if instead else ""
        raise LawError(f"this law sees {sees} only: {what} is not available{hint}")

    return _Unseen(refuse, doc=f"Refuse: a law that sees {sees} only does not know it.")


def alone(values: Float) -> Float:
    """Return a copy that can't be written. A view would lead, as its `base`, to all robots."""
    return locked(values.copy())


MAX_LISTED = 30
"""The most names that an error lists where none is near."""


def unknown(view: object, kind: str, name: str, *more: str) -> NoReturn:
    """Raise UnknownNameError: a view has no such name.

    kind: the view in words. more: names that it has besides those of its class.
    """
    if name.startswith("__"):  # asked for by Python, for example by copy
        raise AttributeError(name)
    kind_of_view = type(view)
    known = [
        item
        for item in dir(kind_of_view)
        if not (item.startswith("_") or isinstance(getattr(kind_of_view, item), _Unseen))
    ]
    names = [*known, *more]
    certain = likely(name, names, CERTAIN)
    hint = certain or instead(name, kind) or nearest(name, names, most=MAX_LISTED)
    raise UnknownNameError(f"{kind} has no {name!r}{hint}")


class Memory(SimpleNamespace):
    """Keeps a law's variables between steps, as attributes: ``robot.memory.integral``."""

    def __getattr__(self, name: str) -> NoReturn:
        if name.startswith("__"):
            raise AttributeError(name)
        raise UnknownNameError(
            f"robot.memory has no {name!r} yet: set it first, or write "
            f"getattr(robot.memory, {name!r}, 0){likely(name, vars(self))}"
        )

    def __getitem__(self, name: Any) -> NoReturn:
        raise LawError(f"robot.memory[{shown(name)}]: write robot.memory.{name}")

    def __setitem__(self, name: Any, value: Any) -> None:
        self[name]


class Mind:
    """The private parts of a robot: its readings, its memory between steps, its random stream."""

    def __init__(self, name: str, stream: Callable[[str], np.random.Generator]) -> None:
        self.sense = Sense(name)
        self.memory = Memory()
        self.name, self._stream = name, stream

    @cached_property
    def rng(self) -> np.random.Generator:
        """The robot's own random stream."""
        return self._stream(f"robot {self.name}")


class _Body:
    """The base of the views of robots, neighbours and props."""

    _kind: ClassVar[str]
    """The name of such a body in an error."""

    _more: ClassVar[tuple[str, ...]] = ()
    """The attributes that it has besides the properties of its class."""

    _family: ClassVar[str] = "robots"
    """The list of `Scenario` that has it."""

    def __init__(self, world: Simulation, index: int) -> None:
        self._world, self._index = world, index

    def __getattr__(self, name: str) -> NoReturn:
        unknown(self, self._kind, name, *self._more, *(f"sense.{key}" for key in self._read))

    def __repr__(self) -> str:
        kind, name = self._kind.partition(" ")[2], getattr(self, "name", "")
        known = (getattr(type(self), place, None) for place in ("pose", "position"))
        seen = next((p.fget(self) for p in known if type(p) is property and p.fget), ())
        place = f" at ({', '.join(f'{number:.4g}' for number in seen)})" if len(seen) else ""
        readings = "".join(f", {name} = {shown(value)}" for name, value in self._read.items())
        return f"<{kind} {name!r}{place}{readings}>"

    @property
    def _read(self) -> dict[str, Any]:
        """What its sensors read, by name."""
        return vars(self.__dict__["sense"]) if "sense" in self.__dict__ else {}

    @property
    def _part(self) -> Any:
        """Its description in the scenario."""
        return getattr(self._world.scenario, self._family)[self._index]

    name: str = through("_part.name")
    """Its name."""

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name.startswith("_") or name in self._more):
            keep = "" if hasattr(type(self), name) else f"; keep things in robot.memory.{name}"
            raise LawError(
                f"{self._kind}'s {name} can't be set: a law returns its command, as "
                f"`return v, omega`{keep}"
            )
        object.__setattr__(self, name, value)

    @property
    def index(self) -> int:
        """Its index: a robot's column in poses and commands, a prop's in ``scenario.props``."""
        return self._index


class Neighbour(_Body):
    """Another robot, as its neighbour sees it: its index, name, position (2,) and pose (3,).

    A law may keep it: its pose is the present one at each step, as long as it is a neighbour.
    """

    _kind = "a neighbour"

    def __init__(self, world: Simulation, index: int, whose: int) -> None:
        """Take the world, its index, and that of the robot whose neighbour it is."""
        super().__init__(world, index)
        self._whose = whose
        self._listed: Sequence[int] = ()  # the list in which it was last found

    def _seen(self) -> Float:
        """Return its pose (3,). Raises LawError if it is a neighbour no more."""
        indices = self._world.neighbour_indices(self._whose)
        if indices is not self._listed:
            if self._index not in indices:
                raise LawError(f"{self.name} is no neighbour any more: ask robot.neighbours again")
            self._listed = indices
        return self._world.pose[:, self._index]

    @property
    def position(self) -> Float:
        """The other robot's position (2,): x, y [m]."""
        return alone(self._seen()[:2])

    @property
    def pose(self) -> Float:
        """The other robot's pose (3,): x, y [m], theta [rad]."""
        return alone(self._seen())


class NeighbourPosition(Neighbour):
    """Another robot whose position alone is seen."""

    pose = unseen("a neighbour's pose", "positions", "neighbour.position")


class PropView(_Body):
    """A prop: its index in ``scenario.props``, name, pose and velocity."""

    _kind = "a prop"
    _family = "props"

    @property
    def pose(self) -> Float:
        """The pose (3,) of its centre of mass: x, y [m], theta [rad, not wrapped]."""
        return self._world.prop_pose[:, self._index]

    @property
    def velocity(self) -> Float:
        """Its velocity (3,): x', y' [m/s], theta' [rad/s]."""
        return self._world.prop_velocity[:, self._index]


class RobotView(_Body):
    """A robot, as its law sees and uses it with full information.

    sense: the readings of its sensors. memory: a place to keep things between steps.
    """

    _kind = "a robot"
    _more = ("sense", "memory")
    _neighbour: type[Neighbour] = Neighbour

    def __init__(self, world: Simulation, index: int, mind: Mind) -> None:
        super().__init__(world, index)
        self._mind = mind
        self.sense = mind.sense
        self.memory = mind.memory
        self._found: dict[int, Neighbour] = {}
        self._listed: tuple[Sequence[int], tuple[Neighbour, ...]] = ((), ())

    drive: Drive = through("_part.drive")
    """Its drive, with its limits."""
    radius: float = through("_part.radius")
    """The radius of its chassis, or of a circle round it, metres."""
    time: float = through("_world.time")
    """The simulated time, seconds."""
    sampling_time: float = through("_world.sampling_time")
    """The time from one command to the next, seconds."""
    rng: np.random.Generator = through("_mind.rng")
    """The robot's own random stream."""
    world: Any = through("_world.view")
    """The whole world: all poses, props, contacts, obstacles, add-ons."""

    @property
    def diameter(self) -> float:
        """Twice the radius, metres."""
        return 2 * self.radius

    @property
    def command(self) -> Float:
        """The last command (m,) that was issued, after saturation; zeros at first."""
        return alone(self._world.command[: len(self.drive.inputs), self._index])

    @property
    def effort(self) -> float:
        """The largest share of its bounds that its drive used in the last step, 0 to 1: slip."""
        return float(self._world.effort[self._index])

    def send(self, content: Any, to: Any = None) -> None:
        """Send a message to other robots, by the add-on Communication.

        content: None, True or False, a number, text, an array of these, or a list, tuple or dict
        of these. to: a robot's index or name, a list of these, or None for all in reach. Raises
        LawError for anything else, and where there is no such add-on.
        """
        self._world.channel.send(self._index, content, to)

    @property
    def inbox(self) -> tuple[Message, ...]:
        """The messages that have arrived for this control step, by sender."""
        return self._world.channel.inbox(self._index)

    @property
    def position(self) -> Float:
        """The robot's own position (2,): x, y [m]."""
        return alone(self._world.pose[:2, self._index])

    @property
    def pose(self) -> Float:
        """The robot's own pose (3,): x, y [m], theta [rad, not wrapped]."""
        return alone(self._world.pose[:, self._index])

    @property
    def velocity(self) -> Float:
        """The robot's own velocity (3,): x', y' [m/s], theta' [rad/s]."""
        return alone(self._world.velocity[:, self._index])

    @property
    def neighbours(self) -> tuple[Neighbour, ...]:
        """The other robots that ``Scenario.neighbours`` makes its neighbours now."""
        indices = self._world.neighbour_indices(self._index)
        if indices is not self._listed[0]:
            for j in {*indices} - self._found.keys():
                self._found[j] = self._neighbour(self._world, j, self._index)
            self._listed = indices, tuple(self._found[j] for j in indices)
        return self._listed[1]

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts of this robot since the last step: rows as in ``record.contacts``.

        Normals and tangential impulses are those on b, which may be this robot or the other body.
        """
        rows = self._world.contacts
        return np.asarray(rows[(rows["a"] == self._index) | (rows["b"] == self._index)])


class PartialView(RobotView):
    """A robot whose law sees its own state and its neighbours, but not the whole world."""

    world = unseen("robot.world", "itself and its neighbours", "robot.neighbours")


class PositionsView(PartialView):
    """A robot whose law sees its own state, and the positions of its neighbours."""

    _neighbour = NeighbourPosition
    world = unseen("robot.world", "itself and its neighbours' positions", "robot.neighbours")


class SensorsOnlyView(RobotView):
    """A robot whose law sees sensors only: no pose, no other robots, no points of contact."""

    world = unseen("robot.world", "sensors")
    position = unseen("robot.position", "sensors")
    pose = unseen("robot.pose", "sensors")
    velocity = unseen("robot.velocity", "sensors")
    neighbours = unseen("robot.neighbours", "sensors")
    contacts = unseen("robot.contacts", "sensors")


VIEWS: dict[str, type[RobotView]] = {
    "full": RobotView,
    "partial": PartialView,
    "positions": PositionsView,
    "sensors": SensorsOnlyView,
}
"""The view that a robot's law is given, by ``Robot.sees``."""
