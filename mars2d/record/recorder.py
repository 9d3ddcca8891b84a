"""The record of a run that goes on, written row by row."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import whole
from mars2d.core.errors import InputError, LawError, shown
from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.record.columns import Column
from mars2d.record.contact import CONTACT
from mars2d.record.interventions import Intervention
from mars2d.record.message import MESSAGE, as_of, in_flight
from mars2d.record.rows import COLUMNS, Rows, shapes_of
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.error_model import as_numbers

Float = NDArray[np.float64]

KEPT = frozenset({np.dtype(bool), np.dtype(float)})
"""The types in which readings are kept; a 3 is kept as 3.0, since 3.5 may follow."""


def _column(name: str) -> Any:
    """Return a property: the rows so far of a column."""
    return property(lambda history: history._recorder.column(name))


class History:
    """The record so far, as views: time (k,), pose (k, 3, n), command (k, 2, n) and so on."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder

    time: Float = _column("time")
    """The times of the rows, (k,) seconds."""
    pose: Float = _column("pose")
    """The poses of the robots, (k, 3, n)."""
    command: Float = _column("command")
    """The commands issued, (k, m, n)."""
    command_time: Float = _column("command_time")
    """When each command takes effect, (k,) seconds."""
    prop_pose: Float = _column("prop_pose")
    """The poses of the props, (k, 3, p)."""
    effort: Float = _column("effort")
    """The drives' efforts, (k, n); see `World.effort`."""
    velocity: Float = _column("velocity")
    """The velocities of the robots, (k, 3, n); see `World.velocity`."""
    prop_velocity: Float = _column("prop_velocity")
    """The velocities of the props, (k, 3, p)."""
    work: Float = _column("work")
    """The work since the start, (k, 6) J; see `World.energy`."""

    def __len__(self) -> int:
        return self._recorder.rows


class Recorder:
    """Writes the rows of one run.

    scenario: the one at the start. rows: how many there are. sensor_robots: the robots that carry
    each sensor that is recorded. keeps: whether it writes anything.
    """

    keeps: ClassVar[bool] = True

    def __init__(
        self,
        scenario: Scenario,
        versions: Callable[[], Mapping[str, str]] = dict,
        options: Mapping[str, Any] | None = None,
    ) -> None:
        """Make the columns for the robots and sensors of a scenario.

        versions: returns the versions of the software on which the numbers depend, for the record.
        options: the options that the experiment was opened with, for the record.
        """
        self.versions, self.options = versions, dict(options or {})
        n, props = len(scenario.robots), len(scenario.props)
        capacity = min(scenario.last_iteration + 1, 4096)
        shapes = shapes_of(n, props, scenario.inputs)
        self._columns = {name: Column(row, float, capacity) for name, row in shapes.items()}
        self._places: list[tuple[str, NDArray[Any]]] = []  # where rows of columns are written
        self._room = 0  # the number of rows that all of them have
        self._capacity = capacity
        self.scenario = scenario
        self._sensors: dict[str, Column] = {}
        self._contacts = Column((), CONTACT, 64)
        self._messages = Column((), MESSAGE, 64)
        self._contact_count, self._message_count, self._longest_flight = 0, 0, 0.0
        self._contents: list[str] = []
        self.rows = 0
        self.sensor_robots: dict[str, tuple[int, ...]] = {}
        self._blamed: dict[str, called] = {}  # for an error in a sensor's readings
        for i, robot in enumerate(scenario.robots):
            for sensor in robot.sensors:
                if sensor.recorded:
                    self.sensor_robots[sensor.key] = (*self.sensor_robots.get(sensor.key, ()), i)
                    blamed = called(f"sensor {sensor.key!r}", sensor.read)
                    self._blamed.setdefault(sensor.key, blamed)

    def write(
        self, readings: Mapping[str, Sequence[Any] | NDArray[Any]], **columns: Float | float
    ) -> None:
        """Write a row: the readings by the sensors' names, and the rows of all columns by name."""
        row = self.rows
        if row >= self._room:
            places = [(name, column.place(row)) for name, column in self._columns.items()]
            self._room = min(len(place) for _, place in places)
            self._places = [(name, place) for name, place in places if place.size]
        for name, place in self._places:
            place[row] = columns[name]
        for name, values in readings.items():
            try:
                self._write_readings(row, name, values)
            except BaseException as error:
                self._blamed[name].blame(error)
                raise
        self.rows += 1

    def _write_readings(self, row: int, name: str, values: Sequence[Any] | NDArray[Any]) -> None:
        given = _as_reading(name, values)
        column = self._sensors.get(name)
        if column is None:
            column = self._sensors[name] = Column(given.shape, given.dtype, self._capacity)
        if given.shape != column.shape or given.dtype != column.dtype:
            raise LawError(
                f"sensor {name!r} read {shown(values)}: the shape and kind of a reading can't "
                f"change; it was {_kind(column.dtype, column.shape)}, now it is "
                f"{_kind(given.dtype, given.shape)}"
            )
        column.write(row, given)

    def write_contacts(self, contacts: NDArray[np.void]) -> None:
        """Write the contacts of one control step."""
        if len(contacts):
            self._contacts.write_block(self._contact_count, contacts)
            self._contact_count += len(contacts)

    def contacts(self) -> NDArray[np.void]:
        """Return all contacts so far."""
        return self._contacts.upto(self._contact_count)

    def write_messages(self, text: str, rows: NDArray[np.void]) -> None:
        """Write a content that was sent, and its rows (k,) of MESSAGE, one for each receiver.

        The rows' field `content` is set here.
        """
        rows["content"] = len(self._contents)
        self._contents.append(text)
        self._messages.write_block(self._message_count, rows)
        self._message_count += len(rows)
        flights = rows["arrival"] - rows["time"]
        self._longest_flight = float(np.fmax.reduce(flights, initial=self._longest_flight))

    def in_flight(self, time: float) -> NDArray[np.void]:
        """Return the messages that were under way in the control step that led to a time, s."""
        messages = self._messages.upto(self._message_count)
        return in_flight(messages, time, self.scenario.sampling_time, self._longest_flight)

    def messages(self) -> tuple[NDArray[np.void], Sequence[str]]:
        """Return all messages so far, and the texts to which their field `content` refers."""
        return self._messages.upto(self._message_count), self._contents

    def sensors(self) -> dict[str, NDArray[Any]]:
        """Return the readings so far by the names of sensors; see `Record.sensors`."""
        return {name: column.upto(self.rows) for name, column in self._sensors.items()}

    @property
    def counts(self) -> tuple[int, int, int, int]:
        """The numbers of rows, contacts, messages and contents."""
        return self.rows, self._contact_count, self._message_count, len(self._contents)

    def upto(self, rows: int, contacts: int, messages: int, contents: int) -> Recorder:
        """Return a recorder in memory that has written no more than this; see `counts`."""
        begun = Recorder(self.scenario, self.versions, self.options)
        begun.rows, begun._longest_flight = rows, self._longest_flight
        for name, column in self._sensors.items():
            begun._sensors[name] = Column(column.shape, column.dtype, self._capacity)
        for mine, others in ((begun._columns, self._columns), (begun._sensors, self._sensors)):
            for name, column in others.items():
                mine[name].write_block(0, column.upto(rows))
        begun.write_contacts(self._contacts.upto(contacts))
        begun._messages.write_block(0, self._messages.upto(messages))
        begun._message_count = messages
        begun._contents = self._contents[:contents]
        return begun

    def row(self, row: int) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return a row of all columns by name, and of all sensors by name."""
        return (
            {name: column.row(row) for name, column in self._columns.items()},
            {name: column.row(row) for name, column in self._sensors.items()},
        )

    def column(self, name: str) -> NDArray[Any]:
        """Return a column so far, as a view that can't be written."""
        return self._columns[name].upto(self.rows)

    def record(
        self,
        seed: int,
        over_message: str,
        finished: bool,
        filename: str,
        drawn: Scene,
        interventions: Sequence[Intervention] = (),
    ) -> Rows:
        """Return the record so far; later rows do not change it."""
        columns: dict[str, Any] = {name: self.column(name) for name in COLUMNS}
        now = float(columns["time"][-1]) if self.rows else 0.0
        return Rows(
            scenario=self.scenario,
            seed=seed,
            **columns,
            sensors=self.sensors(),
            sensor_robots={k: v for k, v in self.sensor_robots.items() if k in self._sensors},
            contacts=self.contacts(),
            messages=as_of(self._messages.upto(self._message_count), now),
            contents=tuple(self._contents),
            over_message=whole(over_message),
            finished=finished,
            filename=whole(filename),
            versions=self.versions(),
            drawn=drawn,
            interventions=tuple(each for each in interventions if each.row < self.rows),
            options=self.options,
        )


class Unrecorded(Recorder):
    """Writes nothing, for worlds that keep no record, such as those of learners and forks."""

    keeps: ClassVar[bool] = False

    def write(
        self, readings: Mapping[str, Sequence[Any] | NDArray[Any]], **columns: Float | float
    ) -> None:
        """Write no row."""

    def write_contacts(self, contacts: NDArray[np.void]) -> None:
        """Write no contacts."""

    def write_messages(self, text: str, rows: NDArray[np.void]) -> None:
        """Write no messages."""

    def record(self, *_: Any, **__: Any) -> NoReturn:
        """Raise InputError."""
        raise InputError("this world keeps no record: make it without record=False")


def _as_reading(name: str, values: Sequence[Any] | NDArray[Any]) -> NDArray[Any]:
    """Return the readings of the robots that carry sensor `name` as one array (m, ...)."""
    if isinstance(values, np.ndarray) and values.dtype in KEPT:
        return values
    given = as_numbers(
        name, values,
        "a number, True or False, or an array of them, of the same shape on each robot (else give "
        "the sensors other names)",
    )  # fmt: skip
    flags = (isinstance(each, bool) or getattr(each, "dtype", None) == "bool" for each in values)
    if given.dtype != bool and any(flags):
        raise LawError(
            f"sensor {name!r} read {shown(values)}: True or False on one robot and numbers on "
            "another; give the sensors other names"
        )
    return given


def _kind(dtype: np.dtype[Any], shape: tuple[int, ...]) -> str:
    what = "True or False" if dtype.kind == "b" else "numbers"
    return f"{what} of shape {shape[1:]}" if len(shape) > 1 else what
