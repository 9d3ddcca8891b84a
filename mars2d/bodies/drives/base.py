"""The base of drives: from a command to the motion that it asks for, and the force for it."""

from __future__ import annotations

from functools import cached_property
from math import inf
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import Description, flag, number, wrong
from mars2d.core.quantity import UNKNOWN, Quantity

Float = NDArray[np.float64]

STICK_TURN = 1.5
"""How quickly a robot turns by a stick that is held to the side, rad/s, if its wheels can."""

HUGE = 1e9
"""A number of a command, in any unit, that every limited drive limits."""

TWIST = Quantity("v", "m/s"), Quantity("omega", "rad/s")
"""The inputs of drives that turn."""

ROUNDING = 1e-12
"""The share by which a command may exceed its limits, so that limiting twice changes nothing."""


class Drive(Description):
    """The base of all drives.

    A drive turns a command (m,) into a motion; `inputs` names its m numbers, 1 to 4, two if it does
    not say. A drive of one's own needs `twist` only. Every method works on the columns of many
    robots at once. A command takes these steps:

    1. `saturate` limits it to what the actuators can do, `accelerate` to what they can reach from
       the last command within a sampling time; the result is recorded;
    2. it waits for `Scenario.command_delay` and for the drive's `dead_time`;
    3. the actuators change to it as quickly as they can, and `ramp` says how far they are;
    4. `disturb` adds the actuators' noise, which is neither recorded nor limited;
    5. `twist` returns the velocity that it asks for; `noisy_twist` does 4 and 5 together.

    There are as many actuators as `rates`. By default a command has the speed of each.

    `noise` is the density of white noise, in shares of the speed: in a control step of T seconds a
    speed u is off by a normal number of deviation u noise / sqrt(T). So an actuator's way is off by
    a random walk, whose deviation after t seconds is u noise sqrt(t), whatever T. A limit after the
    noise would cut off the more the shorter T is, and so make the walk depend on it.

    Source of the noise: Maybeck, Stochastic Models, Estimation and Control, volume 1 (1979),
    section 4.5.
    """

    max_linear_speed: float = number(
        default=0.5, above=0, high=1e3, unit="m/s", doc="bound of the speed"
    )
    max_force: float = number(
        default=5.0, above=0, high=1e6, unit="N", doc="the largest force of the drive"
    )
    max_torque: float = number(
        default=0.5, above=0, high=1e6, unit="N m", doc="the largest torque of the drive"
    )
    force_limited: bool = flag(
        default=False,
        doc="whether max_force and max_torque also bound its acceleration without contact",
    )
    max_acceleration: float | None = number(
        default=None, low=1e-6, high=1e6, unit="m/s^2", optional=True,
        doc="bound of its actuators' acceleration; None: no bound",
    )  # fmt: skip
    no_load_speed: float | None = number(
        default=None, above=0, high=1e6, unit="m/s", optional=True,
        doc="speed at which its motors' force, max_force at rest, has fallen to 0; None: never",
    )  # fmt: skip
    grip: float | None = number(
        default=None, above=0, high=100, optional=True,
        doc="friction of its wheels along their direction: they hold grip m g; None: any force",
    )  # fmt: skip
    side_grip: float | None = number(
        default=None, above=0, high=100, optional=True,
        doc="friction of its wheels across their direction; None: as along",
    )  # fmt: skip
    noise: float = number(
        default=0.0, low=0, high=1, unit="sqrt(s)",
        doc="standard deviation of an actuator's path after one second, as a share of it",
    )  # fmt: skip
    dead_time: float = number(
        default=0.0, low=0, high=1e6, unit="s",
        doc="from a command's arrival to its effect, on top of the scenario's `command_delay`",
    )  # fmt: skip

    frame: ClassVar[Literal["robot", "world"]] = "robot"
    """The frame that `twist` gives linear velocities in."""

    holonomic: ClassVar[bool] = False
    """Whether it can move in any direction at once."""
    second_stick: ClassVar[bool] = False
    """Whether a second stick turns it: then `steered` takes a third number."""
    wheel_names: ClassVar[tuple[str, str] | None] = None
    """The names of the two actuators if they are wheels, as the inspector shows them."""

    def _validate(self) -> None:
        known = isinstance(self.inputs, tuple) and 1 <= len(self.inputs) <= 4
        if not (known and all(isinstance(each, Quantity) for each in self.inputs)):
            expected = "a tuple of 1 to 4 quantities, such as (Quantity('v', 'm/s'),)"
            raise wrong(f"{type(self).__name__}.inputs", self.inputs, expected)

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """The numbers of a command, 1 to 4; by default two whose units are not known."""
        return UNKNOWN

    def saturate(self, command: Float) -> Float:
        """Return commands (m, n) within the actuators' limits; by default, unchanged."""
        return command

    @cached_property
    def bounds(self) -> Float:
        """The least (row 0) and the largest value (row 1) of each number of a command, (2, m).

        +-inf where `saturate` does not limit it. Not every command within these bounds can be
        followed: two wheels at their limit can't turn.

        >>> from mars2d import Holonomic
        >>> Holonomic(max_linear_speed=0.5).bounds.tolist()
        [[-0.5, -0.5], [0.5, 0.5]]
        """
        one = np.eye(len(self.inputs))
        pairs = np.array([self.saturate(sign * HUGE * one).diagonal() for sign in (-1.0, 1.0)])
        return np.where(np.abs(pairs) >= HUGE, np.copysign(inf, pairs), pairs)

    def twist(self, command: Float) -> Float:
        """Return (3, n): two components of velocity [m/s], in `frame`, and spin [rad/s].

        A row may be one number for all robots: ``return v, 0, omega``.
        """
        raise NotImplementedError(f"{type(self).__name__} must say how it moves")

    def actuators(self, command: Float) -> Float:
        """Return the speeds (A, n) that commands (m, n) ask of the actuators."""
        return command

    def command_for(self, actuators: Float) -> Float:
        """Return the commands (m, n) that ask for these speeds (A, n) of the actuators."""
        return actuators

    def steered(self, across: float, ahead: float) -> tuple[float, ...]:
        """Return the command that a stick asks for which is held across to the right, and ahead.

        across, ahead: from -1 to 1, in the picture for a drive that moves in the world's frame.
        Here, the first number of a command is a speed; the second is a spin, or a speed, too;
        others are 0. A drive with a `second_stick` takes its deflection to the right, too.
        """
        most = self.max_linear_speed
        if self.frame == "world":
            return most * across, most * ahead
        return (most * ahead, -STICK_TURN * across, 0.0, 0.0)[: len(self.inputs)]

    def turning_radius(self, speed: float) -> float:  # noqa: ARG002
        """Return the least radius of its arcs at a speed [m/s], metres; 0: it turns on the spot."""
        return 0.0

    @property
    def rates(self) -> tuple[float | None, ...]:
        """The largest change of each actuator in a second, in its own unit; None: unlimited."""
        return (self.max_acceleration,) * len(self.inputs)

    @cached_property
    def _fastest_change(self) -> Float:
        """The rates as an array (A, 1), inf for None."""
        return np.array([[inf if rate is None else rate] for rate in self.rates])

    @property
    def grips(self) -> tuple[float | None, float | None]:
        """The friction of its wheels along and across them; None: they bear any force."""
        return self.grip, self.grip if self.side_grip is None else self.side_grip

    def strength(self, weight: float) -> tuple[float, float]:  # noqa: ARG002
        """Return the largest force [N] and torque [N m] of the drive of a robot of a weight [N]."""
        return self.max_force, self.max_torque

    def accelerate(self, command: Float, last: Float, duration: float) -> Float:
        """Return commands (m, n) with the change of each actuator limited.

        last: (m, n), the commands issued `duration` seconds before.
        """
        had = self.actuators(last)
        change = self.actuators(command) - had
        most = self._fastest_change * duration
        over = np.abs(change) > most + ROUNDING * (most + np.abs(had).max(axis=0))
        if not np.count_nonzero(over):
            return command
        return np.where(over.any(axis=0), self.command_for(had + change.clip(-most, most)), command)

    def ramp(self, command: Float, last: Float, start: float, end: float) -> Float:
        """Return the commands (m, n) that the actuators follow in the mean over some time.

        last: (m, n), those that they followed when commands (m, n) came. start, end: of the time
        since then, seconds. They change as quickly as they can, and stay where they have arrived.
        """
        had = self.actuators(last)
        change = self.actuators(command) - had
        share = reached(np.abs(change) / self._fastest_change, start, end)
        return self.command_for(had + share * change)

    def disturb(self, command: Float, normal: Float) -> Float:
        """Return commands (m, n) as noisy actuators execute them: each is off by a random share.

        normal: (A, n), normal numbers with variance 1 / T [1/s], one for each actuator: the means
        over a control step of T seconds of white noise of density 1.
        """
        return self.command_for(self.actuators(command) * (1.0 + self.noise * normal))

    def noisy_twist(self, command: Float, normal: Float) -> Float:
        """Return the twists (3, n) of noisy actuators.

        normal: (A, n), as in `disturb`.
        """
        return self.twist(self.disturb(command, normal))


def reached(takes: Float, start: float, end: float) -> Float:
    """Return which share of a change is done in the mean from `start` to `end` seconds.

    takes: seconds, how long it takes, at a constant rate; the time counts from its beginning.
    """
    done = [
        np.where(t < takes, t * t / (2 * np.maximum(takes, t)), t - takes / 2) if t else 0.0
        for t in (start, end)
    ]
    return np.asarray((done[1] - done[0]) / (end - start))


class Turning(Drive):
    """The base of drives that turn.

    At the speed v its arcs have a radius of v / `max_angular_speed` at least, as those of a Dubins
    vehicle have.
    """

    max_angular_speed: float | None = number(
        default=None, low=1e-3, high=1e3, unit="rad/s", optional=True,
        doc="bound of its angular speed; None: no bound of its own",
    )  # fmt: skip

    def turning_radius(self, speed: float) -> float:
        """Return the least radius of its arcs at a speed [m/s], metres; 0: it turns on the spot."""
        return 0.0 if self.max_angular_speed is None else abs(speed) / self.max_angular_speed
