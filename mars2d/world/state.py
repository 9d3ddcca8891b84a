"""The state of a running world: clock, bodies, add-ons, random streams, and the rows so far."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from functools import cached_property
from types import SimpleNamespace
from typing import Any, NoReturn, Self

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.base import HOOKS, Addon, hooks_of
from mars2d.core.arrays import locked, sealed
from mars2d.core.errors import InputError, UnknownNameError, nearest
from mars2d.core.streams import stream
from mars2d.core.usercode import called
from mars2d.physics.engine import Engine, Kinematics
from mars2d.physics.versions import versions
from mars2d.record.contact import CONTACT
from mars2d.record.energy import Energy, Momentum, energy_of, momentum_of
from mars2d.record.recorder import History, Recorder, Unrecorded
from mars2d.scenario.scenario import Scenario

ENGINES: dict[str, type[Engine | Kinematics]] = {
    "contact": Engine,
    "stop": Kinematics,
    "ideal": Kinematics,
}
"""The class that moves the bodies, by Scenario.physics."""

Float = NDArray[np.float64]


FORKING = "a fork of a world"
"""The key of a memo of `deepcopy` with which a whole world is copied."""


class Uncopied:
    """The base of a world: a copy would share half of it, and mix two runs."""

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        raise InputError(
            "a world can't be copied, pickled or sent to another process: world.fork() goes on "
            "from here, World(world.scenario, control, world.seed) starts again, and world.record "
            "is data"
        )

    def __deepcopy__(self, memo: dict[Any, Any]) -> Self:
        """Copy this as a part of a whole world, or raise InputError."""
        if FORKING not in memo:
            self.__reduce_ex__(4)
        copied = memo[id(self)] = object.__new__(type(self))
        vars(copied).update({name: deepcopy(value, memo) for name, value in vars(self).items()})
        return copied


class Addons(SimpleNamespace):
    """The add-ons of a world by name: ``world.addons.map``."""

    def __getattr__(self, name: str) -> NoReturn:
        raise UnknownNameError(f"this world has no add-on {name!r}{nearest(name, vars(self))}")

    @classmethod
    def of(
        cls,
        described: Sequence[Addon],
        there: Mapping[str, Addon],
        stream: Callable[[str], np.random.Generator],
    ) -> Addons:
        """Return live copies of a scenario's add-ons.

        there: live add-ons by name that go on. stream: returns a random stream by its name.
        """
        return cls(
            **{
                addon.key: there.get(addon.key) or addon.live(rng=stream(f"add-on {addon.key}"))
                for addon in described
            }
        )


class Hooks:
    """Calls the hooks that live add-ons define, in the order of the add-ons."""

    def __init__(self, addons: Addons) -> None:
        self._hooks = {
            hook: [
                (key, getattr(a, hook)) for key, a in vars(addons).items() if hook in hooks_of(a)
            ]
            for hook in HOOKS
        }

    def defines(self, hook: str) -> bool:
        """Return whether any add-on has a hook."""
        return bool(self._hooks[hook])

    def call(self, hook: str, *args: Any) -> None:
        """Call a hook of all add-ons. Raises LawError, which names the add-on that raised."""
        for key, method in self._hooks[hook]:
            with called(f"add-on {key!r}", method):
                method(*args)


class State(Uncopied):
    """The state of a world at this instant; `Simulation` makes it go on.

    All arrays are read only, and new at each control step. n robots, p props.

    pose, prop_pose: (3, n) and (3, p): x, y [m], theta [rad]. command: (m, n), the last one, after
    saturation. contacts: since the last control step. effort: (n,), 0 to 1, in that step. driven:
    the twists that the drives asked for in it, see `Surroundings.driven`. engine: moves the bodies.
    recorder: writes the rows. addons: by name.
    """

    def __init__(
        self,
        scenario: Scenario,
        seed: int,
        record: bool,
        options: Mapping[str, Any],
    ) -> None:
        """Put the bodies where they start.

        record: whether it is recorded. options: that the record states.
        """
        self.scenario = scenario
        self.seed = seed
        self.iteration = 0
        self.over = False
        self.over_message = ""
        self.broken_off = False
        self.recorder = (Recorder if record else Unrecorded)(scenario, versions, options)
        self.history = History(self.recorder)
        self.addons = Addons()
        n = len(scenario.robots)
        self.command: Float = locked(np.zeros((scenario.inputs, n)))
        self.contacts: NDArray[np.void] = np.empty(0, dtype=CONTACT)
        self.effort: Float = locked(np.zeros(n))
        self.driven: list[tuple[float, Float]] = []
        self._neighbours: tuple[int, Sequence[Sequence[int]]] = (-1, ())
        self._robots, self._props = slice(n), slice(n, None)  # columns of all bodies' arrays
        self.engine = ENGINES[scenario.physics](scenario)
        self._take_engine()

    def _take_engine(self) -> None:
        self.take_poses()
        self._velocity_at = -1, self.pose
        seen = self.engine.velocity
        self._seen = seen[:, self._robots], seen[:, self._props], self.engine.seen_work

    def take_poses(self) -> None:
        """Take the poses of robots and props from the engine."""
        pose = sealed(self.engine.pose)
        self.pose, self.prop_pose = pose[:, self._robots], pose[:, self._props]

    @property
    def time(self) -> float:
        """The simulated time, seconds."""
        return self.iteration * self.scenario.sampling_time

    @property
    def position(self) -> Float:
        """The positions (2, n): x, y [m]."""
        return self.pose[:2]

    @property
    def sampling_time(self) -> float:
        """The time from one command to the next, seconds."""
        return self.scenario.sampling_time

    @property
    def finished(self) -> bool:
        """Whether the experiment is over, and was not broken off."""
        return self.over and not self.broken_off

    @property
    def velocity(self) -> Float:
        """The robots' velocities (3, n): x', y' [m/s], theta' [rad/s]."""
        return self._velocities[:, self._robots]

    @property
    def prop_velocity(self) -> Float:
        """The props' velocities (3, p)."""
        return self._velocities[:, self._props]

    @property
    def _velocities(self) -> Float:
        """The velocities of all bodies, asked of the engine once a control step."""
        if self._velocity_at[0] != self.iteration:
            self._velocity_at = self.iteration, sealed(self.engine.velocity.copy())
        return self._velocity_at[1]

    def look(self) -> tuple[Float, Float, Float]:
        """Return the velocities of robots and props and the work at this instant, for a moment.

        The next look may write to the same memory.
        """
        self.engine.look()
        return self._seen

    @property
    def work(self) -> Float:
        """The work on all bodies since the start (6,), J; see `mars2d.record.energy.WORK`."""
        return np.array(self.look()[2])

    @property
    def energy(self) -> Energy:
        """The kinetic energies of all bodies, and the work that has made them, J."""
        return energy_of(self.scenario, self._poses, self._velocities, self.work)

    @property
    def momentum(self) -> Momentum:
        """The momenta of all bodies."""
        return momentum_of(self.scenario, self._poses, self._velocities)

    @property
    def _poses(self) -> Float:
        return np.hstack([self.pose, self.prop_pose])

    @cached_property
    def rng(self) -> np.random.Generator:
        """The random stream of the team's law."""
        return self.stream("control")

    def stream(self, name: str) -> np.random.Generator:
        """Return a new random stream that depends on the seed and `name` alone."""
        return stream(self.seed, name)

    def neighbour_indices(self, robot: int) -> Sequence[int]:
        """Return the robots that ``Scenario.neighbours`` makes a robot's neighbours now."""
        asked, found = self._neighbours
        rule = self.scenario.neighbours
        if asked < 0 or (asked != self.iteration and not rule.fixed):
            with called("Scenario.neighbours", rule.of):
                found = rule.of(self.pose[:2])
            self._neighbours = self.iteration, found
        return found[robot]
