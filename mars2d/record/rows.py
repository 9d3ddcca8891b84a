"""The data of a run's record: its columns over time, its contacts and messages."""

from __future__ import annotations

import hashlib
from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NoReturn, Self

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arrays import sealed
from mars2d.core.errors import InputError, UnknownNameError, counted, nearest
from mars2d.core.scene import Scene
from mars2d.record.contact import CONTACT, met, pair_forces, rows_of
from mars2d.record.energy import WORK, Energy, Momentum, energy_of, momentum_of
from mars2d.record.frame import Frame
from mars2d.record.impacts import impacts
from mars2d.record.interventions import Change, Intervention, Leap, leaps_of
from mars2d.record.message import MESSAGE, in_flight, packed
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

COLUMNS: dict[str, tuple[str, ...]] = {
    "time": (),
    "pose": ("axis", "robot"),
    "command": ("input", "robot"),
    "command_time": (),
    "prop_pose": ("axis", "prop"),
    "effort": ("robot",),
    "velocity": ("axis", "robot"),
    "prop_velocity": ("axis", "prop"),
    "work": ("work_of",),
}
"""The columns of every record, with a row for each control step, and the axes of a row."""


def shapes_of(robots: int, props: int, inputs: int) -> dict[str, tuple[int, ...]]:
    """Return the shape of a row of each of `COLUMNS`; inputs: the numbers of a command."""
    sizes = {"axis": 3, "input": inputs, "robot": robots, "prop": props, "work_of": len(WORK)}
    return {name: tuple(sizes[axis] for axis in axes) for name, axes in COLUMNS.items()}


class _BySensor(dict[str, Any]):
    """A dict by the names of the sensors that were recorded; an InputError for others."""

    def __missing__(self, name: str) -> NoReturn:
        known = nearest(name, self, most=30) if self else "; none was recorded"
        raise InputError(f"the record has no sensor {name!r}{known}")

    def __getattr__(self, name: str) -> NoReturn:
        raise UnknownNameError(f"record.sensors.{name}: write record.sensors[{name!r}]")


@dataclass(frozen=True, eq=False)
class Rows:
    """All data of a run. Row k of a column is the world at ``time[k]`` = k sampling times.

    time: (T,) seconds. pose: (T, 3, n) = x, y [m], theta [rad]. command: (T, m, n), issued at
    ``time``, after saturation; it takes effect at command_time (T,). prop_pose: (T, 3, p). effort:
    (T, n), the largest share of its bounds that a drive used in the control step before. velocity,
    prop_velocity: (T, 3, n) and (T, 3, p) = x', y' [m/s], theta' [rad/s] at ``time``, before its
    command takes effect. work: (T, 6) J since the start, of what `mars2d.record.energy.WORK` names.
    sensors: for each sensor's name an array (T, m, ...) of readings, of the m robots in
    ``sensor_robots[name]``. contacts: a row for each control step, pair and normal, with the fields
    of `mars2d.record.CONTACT`. messages: a row for each message and receiver, with the fields of
    `mars2d.record.MESSAGE`; contents: the texts that were sent, as JSON, to which their field
    `content` refers. over_message: why the run ended. finished: False if an error or Ctrl-C ended
    the run, or while it goes on. drawn: the add-ons' drawing at the end, which files do not keep.
    missing: the user's own parts that a file could not hold. interventions: changes that were made
    to the world from outside, in order; `scenario` is the one at the start. options: the options
    with which the experiment was opened, by the names of ``--set``; files keep numbers, texts, and
    lists of these. branches: runs in a window that were left for this one, which are kept in files
    of their own.
    """

    scenario: Scenario
    seed: int
    time: Float
    pose: Float
    command: Float
    command_time: Float
    prop_pose: Float
    effort: Float
    velocity: Float
    prop_velocity: Float
    work: Float
    sensors: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    sensor_robots: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    contacts: NDArray[np.void] = field(default_factory=lambda: np.empty(0, dtype=CONTACT))
    messages: NDArray[np.void] = field(default_factory=lambda: np.empty(0, dtype=MESSAGE))
    contents: Sequence[str] = ()
    over_message: str = ""
    finished: bool = True
    filename: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)
    drawn: Scene = field(default_factory=Scene, repr=False)
    missing: tuple[str, ...] = ()
    interventions: tuple[Intervention, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    branches: tuple[Rows, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        for name in (*COLUMNS, "contacts", "messages"):
            object.__setattr__(self, name, sealed(getattr(self, name)))
        sensors = {name: sealed(values) for name, values in self.sensors.items()}
        object.__setattr__(self, "sensors", _BySensor(sensors))
        object.__setattr__(self, "sensor_robots", _BySensor(self.sensor_robots))

    def __len__(self) -> int:
        return len(self.time)

    def __copy__(self) -> Self:
        return self  # nothing in it can be changed

    def __deepcopy__(self, memo: object) -> Self:
        return self

    def __repr__(self) -> str:
        size = f"{counted(len(self), 'row')}, {counted(len(self.scenario.robots), 'robot')}"
        return f"<Record of {self.scenario.title!r}: {size}, {self.over_message!r}>"

    @cached_property
    def digest(self) -> str:
        """The sha256 over all columns: the same for the same run, to the last bit."""
        return digest_of(self.columns(), self.over_message)

    @cached_property
    def energy(self) -> Energy:
        """The kinetic energy of each body in each row, and the work that has made it, J."""
        kinetic = [
            energy_of(scenario, self.all_poses[rows], self._velocities[rows], self.work).kinetic
            for scenario, rows in self._spans
        ]
        return Energy(np.concatenate(kinetic), self.work)

    @cached_property
    def momentum(self) -> Momentum:
        """The momentum of each body in each row, N s, and the angular one of all, N m s."""
        found = [
            momentum_of(scenario, self.all_poses[rows], self._velocities[rows])
            for scenario, rows in self._spans
        ]
        return Momentum(*map(np.concatenate, zip(*found, strict=True)))

    @property
    def _spans(self) -> list[tuple[Scenario, slice]]:
        """The rows between changes, with the scenario that holds in them."""
        begins = sorted({0, *(change.row for change in self.changes)})
        ends = [*begins[1:], len(self)]
        return [(self.scenario_at(a), slice(a, b)) for a, b in zip(begins, ends, strict=True)]

    @property
    def all_poses(self) -> Float:
        """The poses (T, 3, n + p) of robots and props."""
        return np.concatenate([self.pose, self.prop_pose], axis=-1)

    @property
    def _velocities(self) -> Float:
        return np.concatenate([self.velocity, self.prop_velocity], axis=-1)

    @property
    def steps(self) -> int:
        """How many control steps were done; a run that was cut short has no row after its last."""
        return max(len(self) - self.finished, 0)

    @property
    def collisions(self) -> int:
        """How many times two bodies came to touch that did not touch before."""
        return int(met(self.contacts).sum())

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return all columns as plain arrays, by their names in files.

        The names for sensors, contacts and messages are ``sensor:NAME``, ``contact:FIELD`` and
        ``message:FIELD``. The texts of messages are in ``contents`` (UTF-8, one after the other)
        and ``content_sizes`` (the bytes of each).
        """
        columns: dict[str, NDArray[Any]] = {name: getattr(self, name) for name in COLUMNS}
        columns |= {f"sensor:{name}": values for name, values in sorted(self.sensors.items())}
        # Field by field, since a structured array has undefined bytes between its fields.
        columns |= {f"contact:{name}": self.contacts[name] for name in CONTACT.names or ()}
        if self.contents:
            columns |= {f"message:{name}": self.messages[name] for name in MESSAGE.names or ()}
            columns |= packed(self.contents)
        return columns

    def frame(self, row: int) -> Frame:
        """Return the frame of row `row`; negative numbers count from the end."""
        row = range(len(self))[row]
        last = row == len(self) - 1
        readings = {
            name: [(robot, values[row, k]) for k, robot in enumerate(self.sensor_robots[name])]
            for name, values in self.sensors.items()
        }
        return Frame(
            scenario=self.scenario_at(row),
            time=float(self.time[row]),
            iteration=row,
            pose=self.pose[row],
            path=self.pose[:row],
            readings=readings,
            over_message=self.over_message if last else "",
            prop_pose=self.prop_pose[row],
            contacts=self.contacts[slice(*np.searchsorted(self.contact_rows, [row, row + 1]))],
            effort=self.effort[row],
            prop_path=self.prop_pose[:row],
            contact_log=lambda: self.contacts[: np.searchsorted(self.contact_rows, row, "right")],
            messages=in_flight(
                self.messages,
                float(self.time[row]),
                self.scenario.sampling_time,
                self._longest_flight,
            ),
            command_path=self.command[:row],
            message_log=lambda: (self.messages, self.contents),
            exact_velocity=np.hstack([self.velocity[row], self.prop_velocity[row]]),
            work=self.work[row],
            leaps=self._leaps[: bisect_left(self._leaps, (row + 1, 0))],
            draw_addons=(lambda scene: scene.extend(self.drawn.shapes)) if last else None,
        )

    def scenario_at(self, row: int) -> Scenario:
        """Return the scenario at row `row`, with the changes made at that row."""
        k = bisect_right(self.changes, row, key=lambda change: change.row)
        return self.changes[k - 1].scenario if k else self.scenario

    @cached_property
    def changes(self) -> tuple[Change, ...]:
        """The interventions that changed the scenario, in order."""
        return tuple(each for each in self.interventions if isinstance(each, Change))

    @cached_property
    def _leaps(self) -> tuple[Leap, ...]:
        return leaps_of(self.interventions)

    @cached_property
    def contact_rows(self) -> NDArray[np.intp]:
        """The row at the end of each contact's control step, (c,); see `rows_of`."""
        return rows_of(self.contacts, self.time, self.scenario.sampling_time)

    def impacts(self, row: int | None = None) -> NDArray[np.void]:
        """Return what each touch did, dtype IMPACT; see `mars2d.record.impacts.impacts`."""
        return impacts(self, row)

    @cached_property
    def pair_forces(self) -> NDArray[np.void]:
        """The mean force of each pair in each control step in which it touched, dtype FORCE."""
        return pair_forces(self.contacts, self.contact_rows, self.scenario.sampling_time)

    @cached_property
    def _longest_flight(self) -> float:
        flight = self.messages["arrival"] - self.messages["time"]
        return float(np.nanmax(flight, initial=0.0))


def digest_of(columns: Mapping[str, NDArray[Any]], over_message: str) -> str:
    """Return the sha256 over columns by name, and over why a run ended."""
    sha = hashlib.sha256()
    for name, column in columns.items():
        sha.update(f"{name} {column.dtype.str} {column.shape} ".encode())
        sha.update(column.tobytes())
    sha.update(over_message.encode())
    return sha.hexdigest()
