"""One instant of an experiment, live or recorded, with everything that can be seen of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene
from mars2d.record.contact import CONTACT
from mars2d.record.energy import Energy, Momentum, energy_of, momentum_of
from mars2d.record.interventions import Leap
from mars2d.record.message import MESSAGE
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor

Float = NDArray[np.float64]


def _no_contacts() -> NDArray[np.void]:
    return np.empty(0, dtype=CONTACT)


def _no_message_log() -> tuple[NDArray[np.void], Sequence[str]]:
    return np.empty(0, dtype=MESSAGE), ()


@dataclass(frozen=True, slots=True)
class Frame:
    """The state of an experiment at one instant, and its past.

    pose: (3, n) now. path: (k, 3, n), the poses at all sampling times before, from the start on.
    readings: for each sensor's name the pairs (robot index, reading). sensed: (3, n), the poses at
    which the sensors were read, if they differ from `pose`. read_row: the row at which they were,
    if it is not `iteration`. draw_addons: adds the add-ons' shapes to a scene; None if they are
    unknown. prop_pose: (3, p). contacts: of the control step that led here; effort: (n,), of the
    drives in it. contact_log: returns all contacts so far. prop_path: (k, 3, p), and command_path:
    (k, m, n), at the times of `path`; they may be empty. messages: under way in the control step
    that led here. message_log: returns all messages so far, and the texts to which their field
    `content` refers. exact_velocity: (3, n + p), of robots and props at this instant, and work:
    (6,) J since the start; empty if they are unknown. leaps: when bodies were put elsewhere by
    hand, in order.
    """

    scenario: Scenario
    time: float
    iteration: int
    pose: Float
    path: Float
    readings: Mapping[str, Sequence[tuple[int, Any]]] = field(default_factory=dict)
    over_message: str = ""
    sensed: Float | None = None
    draw_addons: Callable[[Scene], None] | None = None
    prop_pose: Float = field(default_factory=lambda: np.empty((3, 0)))
    contacts: NDArray[np.void] = field(default_factory=_no_contacts)
    effort: Float = field(default_factory=lambda: np.empty(0))
    contact_log: Callable[[], NDArray[np.void]] = _no_contacts
    prop_path: Float = field(default_factory=lambda: np.empty((0, 3, 0)))
    messages: NDArray[np.void] = field(default_factory=lambda: _no_message_log()[0])
    command_path: Float = field(default_factory=lambda: np.empty((0, 2, 0)))
    message_log: Callable[[], tuple[NDArray[np.void], Sequence[str]]] = _no_message_log
    exact_velocity: Float = field(default_factory=lambda: np.empty((3, 0)))
    work: Float = field(default_factory=lambda: np.empty(0))
    leaps: Sequence[Leap] = ()
    read_row: int | None = None

    def measured(self, sensor: Sensor) -> Float:
        """The poses (3, n) from which the readings of a sensor are to be drawn.

        Those of the measurement where it was earlier; else those of now, unless the sensor `stays`.
        """
        read = self.iteration if self.read_row is None else self.read_row
        row = sensor.measured_at(read, self.scenario.sampling_time)
        if row < min(self.iteration, len(self.path)):
            return np.asarray(self.path[row])
        return self.sensed if sensor.stays and self.sensed is not None else self.pose

    @property
    def velocity(self) -> Float:
        """The mean velocities (3, n + p) of robots and props: x', y' [m/s], theta' [rad/s].

        The mean is over the control step that led here, as far as it has got; 0 if unknown, as
        where a body was put elsewhere.
        """
        velocity = np.zeros((3, self.pose.shape[1] + self.prop_pose.shape[1]))
        dt = self.scenario.sampling_time
        row = ceil(self.time / dt - 1e-6) - 1  # at which the control step began
        spent, n = self.time - row * dt, self.pose.shape[1]
        if 0 <= row < len(self.path):
            velocity[:, :n] = (self.pose - self.path[row]) / spent
        if 0 <= row < len(self.prop_path):
            velocity[:, n:] = (self.prop_pose - self.prop_path[row]) / spent
        velocity[:, [body for leap, body in self.leaps if leap > row]] = 0.0
        return velocity

    @property
    def energy(self) -> Energy | None:
        """The kinetic energies of robots and props, and the work since the start; see `Energy`."""
        if not self.work.size:
            return None
        return energy_of(self.scenario, self.all_poses, self.exact_velocity, self.work)

    @property
    def momentum(self) -> Momentum | None:
        """The momenta of robots and props; None if unknown."""
        if not self.work.size:
            return None
        return momentum_of(self.scenario, self.all_poses, self.exact_velocity)

    def body_pose(self, body: int) -> tuple[float, float, float]:
        """Return the pose (x, y [m], theta [rad]) of a body: its index in `Scenario.bodies`."""
        x, y, theta = self.all_poses[:, body].tolist()
        return x, y, theta

    @property
    def all_poses(self) -> Float:
        """The poses (3, n + p) of robots and props."""
        return np.hstack([self.pose, self.prop_pose])


def between(first: Frame, second: Frame, time: float) -> Frame:
    """Return the frame at a time [s] between two frames, its poses by linear interpolation.

    Contacts, efforts and messages are the second's, of the control step that leads there; all else
    is the first's. A body that is put elsewhere stays until then. A time outside is clipped to that
    of the first or the second.
    """
    span = second.time - first.time
    if span <= 0 or time >= second.time:
        return second
    n, before, after = first.pose.shape[1], first.all_poses, second.all_poses
    share = np.full(after.shape[1], max(0.0, (time - first.time) / span))
    share[[body for row, body in second.leaps if row > first.iteration]] = 0.0
    poses = before + share * (after - before)
    return replace(
        first,
        time=max(time, first.time),
        pose=poses[:, :n],
        sensed=first.pose,
        path=second.path,
        prop_pose=poses[:, n:],
        prop_path=second.prop_path,
        contacts=second.contacts,
        effort=second.effort,
        contact_log=second.contact_log,
        command_path=second.command_path,
        messages=second.messages,
    )
