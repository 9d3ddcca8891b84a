"""What parts may use of a scenario, a frame, a robot and a world, as Protocols.

Sensors and add-ons lie below the scenario and the world, so they can't import those classes. They
annotate what they are handed with these Protocols, which `Scenario`, `Frame` and `World` satisfy. A
base class whose methods users override takes `Any` instead: so an override may name the Protocol or
the class itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mars2d.core.plane import Outline

Float = NDArray[np.float64]


class ScenarioLike(Protocol):
    """A scenario, as add-ons see it."""

    @property
    def robots(self) -> Sequence[Any]:
        """The robots' descriptions, n of `mars2d.Robot`."""

    @property
    def addons(self) -> Sequence[Any]:
        """The add-ons, each a `mars2d.addons.Addon`."""

    @property
    def colors(self) -> Sequence[str]:
        """The robots' colours, n of ``#rrggbb``."""

    @property
    def initial_pose(self) -> Float:
        """The poses (3, n) at the start: x, y [m], theta [rad]."""

    @property
    def sampling_time(self) -> float:
        """The time between control steps, seconds."""

    @property
    def last_iteration(self) -> int:
        """The control step at which the stop time is reached."""

    @property
    def workspace(self) -> Outline | None:
        """The polygon in which the robots move [m], or None."""

    @property
    def on_exit(self) -> str:
        """What happens when a robot leaves the workspace: "stop", "ignore" or "wall"."""

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) of the workspace, metres."""

    @property
    def obstacles(self) -> Sequence[Outline]:
        """The outlines of all obstacles [m]."""

    def index_of(self, field: str, robot: str | int) -> int:
        """Return a robot's index. Raises InputError, which names `field`, if there is none."""


class _Instant(Protocol):
    @property
    def scenario(self) -> ScenarioLike:
        """What is simulated."""

    @property
    def time(self) -> float:
        """The simulated time, seconds."""

    @property
    def pose(self) -> Float:
        """The poses (3, n): x, y [m], theta [rad, not wrapped]."""


class FrameLike(_Instant, Protocol):
    """One instant, live or recorded."""

    @property
    def path(self) -> Float:
        """The poses (k, 3, n) at all sampling times before."""

    @property
    def contact_log(self) -> Callable[[], NDArray[np.void]]:
        """Returns all contacts so far, rows of `mars2d.record.CONTACT`."""


class RobotLike(Protocol):
    """A robot while a world runs, with everything known of it, as its sensors see it."""

    @property
    def index(self) -> int:
        """Its column in poses and commands."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def drive(self) -> Any:
        """Its drive, a `mars2d.bodies.Drive`."""

    @property
    def radius(self) -> float:
        """The radius of its chassis, or of a circle round it, metres."""

    @property
    def pose(self) -> Float:
        """Its pose (3,): x, y [m], theta [rad, not wrapped]."""

    @property
    def velocity(self) -> Float:
        """Its velocity (3,): x', y' [m/s], theta' [rad/s]."""

    @property
    def contacts(self) -> NDArray[np.void]:
        """Its contacts since the last control step, rows of `mars2d.record.CONTACT`."""

    @property
    def sense(self) -> Any:
        """The readings of its sensors, as attributes by their names."""


class WorldLike(_Instant, Protocol):
    """A running world, as add-ons see and use it."""

    @property
    def iteration(self) -> int:
        """The number of control steps done."""

    @property
    def position(self) -> Float:
        """The positions (2, n): x, y [m]."""

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts since the last control step, rows of `mars2d.record.CONTACT`."""

    @property
    def robots(self) -> Sequence[RobotLike]:
        """The robots, n."""

    @property
    def addons(self) -> Any:
        """The add-ons, as attributes by their names."""

    def stop(self, why: str) -> None:
        """End the experiment with the present control step, and say why."""

    def hold(self, robot: str | int) -> None:
        """Let a robot stand still from now on, whatever its law says."""
