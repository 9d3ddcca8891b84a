"""What views and the operator use of a running world, as Protocols.

`Simulation` satisfies them; so does the `Mirror` of a world that an isolated law sees. Those that
lie below the scenario are in `mars2d.core.interfaces`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mars2d.physics.motion import Start
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.world.channel import Channel

Float = NDArray[np.float64]


class Team(Protocol):
    """A scenario, or the part of it that laws may know."""

    @property
    def robots(self) -> Sequence[Robot]:
        """The robots' descriptions, n."""

    @property
    def props(self) -> Sequence[Any]:
        """The props' descriptions, p."""


class Seen(Protocol):
    """A running world, as the views of its robots and props read it.

    n robots, p props. A law can't reach it: views keep it to themselves.
    """

    @property
    def scenario(self) -> Team:
        """The bodies' descriptions."""

    @property
    def view(self) -> Any:
        """The world as laws may see it: a `WorldView`."""

    @property
    def time(self) -> float:
        """The simulated time, seconds."""

    @property
    def sampling_time(self) -> float:
        """The time from one command to the next, seconds."""

    @property
    def pose(self) -> Float:
        """The robots' poses (3, n): x, y [m], theta [rad, not wrapped]."""

    @property
    def velocity(self) -> Float:
        """The robots' velocities (3, n): x', y' [m/s], theta' [rad/s]."""

    @property
    def prop_pose(self) -> Float:
        """The props' poses (3, p)."""

    @property
    def prop_velocity(self) -> Float:
        """The props' velocities (3, p)."""

    @property
    def command(self) -> Float:
        """The last command (2, n), after saturation."""

    @property
    def effort(self) -> Float:
        """The drives' efforts (n,), 0 to 1."""

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts since the last control step."""

    @property
    def channel(self) -> Channel:
        """The `Channel`. Raises LawError if there is none."""

    def neighbour_indices(self, robot: int) -> Sequence[int]:
        """Return a robot's neighbours now, by index."""


class Operated(Protocol):
    """A running world, as its operator reads and changes it. n robots, p props."""

    @property
    def scenario(self) -> Scenario:
        """What is simulated now."""

    @property
    def iteration(self) -> int:
        """The number of control steps done."""

    @property
    def pose(self) -> Float:
        """The robots' poses (3, n): x, y [m], theta [rad]."""

    @property
    def prop_pose(self) -> Float:
        """The props' poses (3, p)."""

    @property
    def motion(self) -> Start:
        """How everything moves at this instant."""

    def observe(self) -> None:
        """Read the sensors of this instant, if they have not been read yet."""

    def rebuild(self, start: Start) -> None:
        """Go on with everything moving like this."""

    def go_on(
        self, scenario: Scenario, control: Callable[[Any], Any] | None, start: Start | None
    ) -> None:
        """Go on with another scenario, and with everything moving as `start` says, if given."""
