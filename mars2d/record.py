"""What happened: the columns of a run over time, and how they are kept."""

from __future__ import annotations

import hashlib
import json
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d import interventions, plain
from mars2d.contact import CONTACT
from mars2d.errors import InputError, counted
from mars2d.frame import Frame
from mars2d.interventions import Change, Intervention
from mars2d.message import MESSAGE, in_flight
from mars2d.scenario import Scenario
from mars2d.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["FORMAT", "Record", "load"]

Float = NDArray[np.float64]

FORMAT = 3
"""The version of the file format; files of another one are refused."""

_COLUMNS = ("time", "pose", "command", "command_time", "prop_pose", "effort")


@dataclass(frozen=True, eq=False)
class Record:
    """All data of a run. Row k of a column is the world at ``time[k]`` = k sampling times.

    time: (T,) seconds. pose: (T, 3, n) = x, y [m], theta [rad]. command: (T, 2, n), issued at
    ``time``, after saturation; it takes effect at command_time (T,). prop_pose: (T, 3, p). effort:
    (T, n), the largest share of its bounds that a drive used in the control step before. sensors:
    for each sensor's name an array (T, m, ...) of readings, of the m robots in
    ``sensor_robots[name]``. contacts: one row a pair and control step, with the fields of
    `mars2d.contact.CONTACT`. messages: one row a message and receiver, with the fields of
    `mars2d.message.MESSAGE`; contents: the JSON texts of what was sent, which their field `content`
    numbers. over_message: why the run ended. finished: False when an error or Ctrl-C ended it, or
    while it is not over. drawn: what the add-ons drew at its end, which a file does not keep.
    missing: parts of the user's own that a file did not hold. interventions: what was done to the
    world from outside, in order; `scenario` is what it was at the start. branches: what was run in
    a window and left for this, which is kept in files of its own.
    """

    scenario: Scenario
    seed: int
    time: Float
    pose: Float
    command: Float
    command_time: Float
    prop_pose: Float
    effort: Float
    sensors: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    sensor_robots: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    contacts: NDArray[np.void] = field(default_factory=lambda: np.empty(0, dtype=CONTACT))
    messages: NDArray[np.void] = field(default_factory=lambda: np.empty(0, dtype=MESSAGE))
    contents: tuple[str, ...] = ()
    over_message: str = ""
    finished: bool = True
    filename: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)
    drawn: Scene = field(default_factory=Scene, repr=False)
    missing: tuple[str, ...] = ()
    interventions: tuple[Intervention, ...] = ()
    branches: tuple[Record, ...] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        for name in (*_COLUMNS, "contacts", "messages"):
            object.__setattr__(self, name, _unwritable(getattr(self, name)))
        sensors = {name: _unwritable(values) for name, values in self.sensors.items()}
        object.__setattr__(self, "sensors", sensors)

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        size = f"{counted(len(self), 'row')}, {counted(len(self.scenario.robots), 'robot')}"
        return f"<Record of {self.scenario.title!r}: {size}, {self.over_message!r}>"

    @cached_property
    def digest(self) -> str:
        """The sha256 over all columns: the same for the same run, to the last bit."""
        sha = hashlib.sha256()
        for name, column in self._columns().items():
            sha.update(f"{name} {column.dtype.str} {column.shape} ".encode())
            sha.update(np.ascontiguousarray(column).tobytes())
        sha.update(self.over_message.encode())
        return sha.hexdigest()

    @property
    def collisions(self) -> int:
        """How many times two bodies came to touch."""
        return int(self.contacts["began"].sum())

    def _columns(self) -> dict[str, NDArray[Any]]:
        """Return all columns under the names that they have in a file."""
        columns: dict[str, NDArray[Any]] = {name: getattr(self, name) for name in _COLUMNS}
        columns |= {f"sensor:{name}": values for name, values in sorted(self.sensors.items())}
        # Field by field, since a structured array holds undefined bytes between its fields.
        columns |= {f"contact:{name}": self.contacts[name] for name in CONTACT.names or ()}
        if self.contents:
            texts = [text.encode() for text in self.contents]
            columns |= {f"message:{name}": self.messages[name] for name in MESSAGE.names or ()}
            columns["contents"] = np.frombuffer(b"".join(texts), dtype=np.uint8)
            columns["content_sizes"] = np.array([len(text) for text in texts], dtype=np.int64)
        return columns

    def frame(self, row: int) -> Frame:
        """Return what was seen at row `row`, negative ones counting from the end."""
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
            contacts=self._contacts_before(row),
            effort=self.effort[row],
            prop_path=self.prop_pose[:row],
            effort_path=self.effort[:row],
            contact_log=lambda: self.contacts[: np.searchsorted(self._contact_rows, row, "right")],
            messages=self._messages_before(row),
            command_path=self.command[:row],
            message_log=lambda: (self.messages, self.contents),
            reading_path=lambda name, robot: self._readings_before(row, name, robot),
            draw_addons=(lambda scene: scene.extend(self.drawn.shapes)) if last else None,
        )

    def scenario_at(self, row: int) -> Scenario:
        """Return the scenario as it was at row `row`, after what was changed there."""
        k = bisect_right(self._changes, row, key=lambda change: change.row)
        return self._changes[k - 1].scenario if k else self.scenario

    @cached_property
    def _changes(self) -> list[Change]:
        return [each for each in self.interventions if isinstance(each, Change)]

    @cached_property
    def _contact_rows(self) -> NDArray[np.intp]:
        """The row that each contact's control step led to.

        What began at the very end of a control step belongs to it; what began before it, and has
        the time of its start, too.
        """
        rounding = 1e-6 * self.scenario.sampling_time
        time, began = self.contacts["time"], self.contacts["began"]
        within = time + np.where(began, -rounding, rounding)
        return np.searchsorted(self.time, within, side="left")

    def _contacts_before(self, row: int) -> NDArray[np.void]:
        """Return the contacts of the control step that led to a row."""
        ends = np.searchsorted(self._contact_rows, [row, row + 1])
        return self.contacts[ends[0] : ends[1]]

    def _messages_before(self, row: int) -> NDArray[np.void]:
        """Return the messages that were under way in the control step that led to a row."""
        time, dt = float(self.time[row]), self.scenario.sampling_time
        return in_flight(self.messages, time, dt, self._longest_flight)

    def _readings_before(self, row: int, name: str, robot: int) -> NDArray[Any] | None:
        """Return what a sensor read on a robot before a row, (row, ...), if it is recorded."""
        robots = self.sensor_robots.get(name, ())
        return self.sensors[name][:row, robots.index(robot)] if robot in robots else None

    @cached_property
    def _longest_flight(self) -> float:
        flight = self.messages["arrival"] - self.messages["time"]
        return float(np.nanmax(flight, initial=0.0))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the paths: initial poses hollow, final poses filled, obstacles and grid.

        ax: matplotlib axes to draw on; by default those of a new figure. Returns the axes.
        """
        from mars2d.output.figure import plot_paths

        return plot_paths(self, ax)

    def save(self, path: str | Path) -> Path:
        """Write the record to a file ``.npz`` and return its path; InputError if it can't be."""
        path = Path(path)
        if path.suffix.lower() != ".npz":
            raise InputError(f"{path}: a record is saved as .npz, this ends in {path.suffix!r}")
        header = {
            "format": FORMAT,
            "scenario": plain.from_description(self.scenario),
            "seed": self.seed,
            "over_message": self.over_message,
            "finished": self.finished,
            "filename": self.filename,
            "versions": dict(self.versions),
            "messages": bool(self.contents),
            "sensor_robots": {name: list(robots) for name, robots in self.sensor_robots.items()},
            "interventions": [interventions.to_plain(each) for each in self.interventions],
            "digest": self.digest,
        }
        text = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
        try:
            with path.open("wb") as file:
                np.savez_compressed(file, allow_pickle=False, header=text, **self._columns())
        except OSError as error:
            raise InputError(f"{path}: can't be written: {error.strerror}") from error
        return path


def load(path: str | Path) -> Record:
    """Read a record that `Record.save` wrote. Raises InputError for anything else."""
    path = Path(path)
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as data:
            header = json.loads(data["header"].tobytes())
            other = _of_another_format(header)
            columns = {} if other else {name: data[name] for name in _names(header)}
        record = None if other else _assemble(header, columns)
        damaged = record is not None and record.digest != header["digest"]
    except OSError as error:
        raise InputError(f"{path}: can't be read: {error.strerror or error}") from error
    except Exception as error:  # zip, zlib, numpy and json have their own each
        raise InputError(f"{path}: not a record of MARS2D, or damaged") from error
    if record is None:
        raise InputError(f"{path}: {other}")
    if damaged:
        raise InputError(f"{path}: damaged: its columns do not have the digest that it states")
    return record


def _of_another_format(header: Any) -> str:
    """Return what is to be said of a file of another format than this one's."""
    made = header["versions"].get("mars2d", "?")
    if header["format"] > FORMAT:
        return f"written by a newer version of MARS2D, {made}"
    if header["format"] < FORMAT:
        return f"written by an older version of MARS2D, {made}: run the experiment again"
    return ""


def _names(header: Any) -> list[str]:
    """Return the names of the columns that a file with this header holds."""
    contacts = [f"contact:{name}" for name in CONTACT.names or ()]
    messages = [*(f"message:{name}" for name in MESSAGE.names or ()), "contents", "content_sizes"]
    sensors = [f"sensor:{name}" for name in header["sensor_robots"]]
    return [*_COLUMNS, *contacts, *sensors, *(messages if header["messages"] else ())]


def _messages(columns: dict[str, NDArray[Any]]) -> tuple[NDArray[np.void], tuple[str, ...]]:
    """Return the messages and their contents that a file held."""
    messages = np.zeros(len(columns["message:time"]), dtype=MESSAGE)
    for name in MESSAGE.names or ():
        messages[name] = columns[f"message:{name}"]
    text, ends = columns["contents"].tobytes(), np.cumsum(columns["content_sizes"]).tolist()
    contents = [text[start:end].decode() for start, end in pairwise([0, *ends])]
    return messages, tuple(contents)


def _assemble(header: Any, columns: dict[str, NDArray[Any]]) -> Record:
    """Put a record together from what a file held; raises what it may if that is not a record."""
    contacts = np.zeros(len(columns["contact:time"]), dtype=CONTACT)
    for name in CONTACT.names or ():
        contacts[name] = columns[f"contact:{name}"]
    messages, contents = _messages(columns) if header["messages"] else (np.zeros(0, MESSAGE), ())
    robots = {name: tuple(indices) for name, indices in header["sensor_robots"].items()}
    scenario, missing = plain.to_scenario(header["scenario"])
    rows, n, props = len(columns["time"]), len(scenario.robots), len(scenario.props)
    wanted = [(rows,), (rows, 3, n), (rows, 2, n), (rows,), (rows, 3, props), (rows, n)]
    shapes: dict[str, tuple[int, ...]] = dict(zip(_COLUMNS, wanted, strict=True))
    shapes |= {f"sensor:{name}": (rows, len(robots[name])) for name in robots}
    for name, shape in shapes.items():
        if columns[name].shape[: len(shape)] != shape:
            raise ValueError(f"column {name} has the shape {columns[name].shape}")
    return Record(
        scenario=scenario,
        seed=header["seed"],
        time=columns["time"],
        pose=columns["pose"],
        command=columns["command"],
        command_time=columns["command_time"],
        prop_pose=columns["prop_pose"],
        effort=columns["effort"],
        sensors={name: columns[f"sensor:{name}"] for name in robots},
        sensor_robots=robots,
        contacts=contacts,
        messages=messages,
        contents=contents,
        over_message=header["over_message"],
        finished=header["finished"],
        filename=header["filename"],
        versions=dict(header["versions"]),
        missing=missing,
        interventions=tuple(interventions.of_plain(each) for each in header["interventions"]),
    )


def _unwritable(array: NDArray[Any]) -> NDArray[Any]:
    """Return a view that can't be written: a digest holds for what it was made of."""
    view = array.view()
    view.flags.writeable = False
    return view
