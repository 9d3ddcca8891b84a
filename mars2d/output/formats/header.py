"""The header of a record's file, which holds all that is not in columns; and records from both."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from hashlib import sha256
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError
from mars2d.record import interventions
from mars2d.record.columns import Texts
from mars2d.record.contact import CONTACT
from mars2d.record.energy import WORK
from mars2d.record.message import MESSAGE
from mars2d.record.rows import COLUMNS, FORMER, Rows, digest_of
from mars2d.scenario import pictures, serialize

Columns = Mapping[str, NDArray[Any]]

FORMAT = 4
"""The version of the contents of files. Later ones are refused, and those before the former."""

FORMER_FORMAT = 3
"""The version of files of records whose velocities and work are unknown."""

SUMS = "sums"
"""The name of the check sums in a header."""

NOT_KEPT = np.empty(0)
"""In place of a column that files of the former version do not have."""

TEXTS = ("contents", "content_sizes")
"""The columns that are texts. Formats for text and numbers keep them with the header."""


def of_record(record: Rows) -> dict[str, Any]:
    """Return everything in a record but its columns, as dicts, lists, text and numbers."""
    return {
        "format": FORMAT if record.kept == COLUMNS else FORMER_FORMAT,
        "scenario": serialize.from_description(pictures.enclosed(record.scenario)),
        "seed": record.seed,
        "over_message": record.over_message,
        "finished": record.finished,
        "filename": record.filename,
        "versions": dict(record.versions),
        "messages": bool(record.contents),
        "sensor_robots": {name: list(robots) for name, robots in record.sensor_robots.items()},
        "interventions": [interventions.to_plain(each) for each in record.interventions],
        **_options_of(record),
        "digest": record.digest,
    }


def _options_of(record: Rows) -> dict[str, Any]:
    """Return the options that a file can hold; nothing where there are none."""
    plain = {}
    for name, value in record.options.items():
        with suppress(TypeError, ValueError):  # such as a Map, or NaN
            plain[str(name)] = json.loads(json.dumps(value, allow_nan=False))
    return {"settings": plain} if plain else {}


def numbers_of(record: Rows) -> dict[str, NDArray[Any]]:
    """Return all columns of a record except those that are texts."""
    return {name: column for name, column in record.columns().items() if name not in TEXTS}


def with_shapes(record: Rows) -> dict[str, Any]:
    """Return the header for a format in which columns lose their types or shapes.

    In addition to `of_record`, ``columns`` has the type and shape of each column, and ``contents``
    the texts of messages.
    """
    kept = {name: [each.dtype.str, each.shape] for name, each in numbers_of(record).items()}
    return of_record(record) | {"columns": kept, "contents": list(record.contents)}


def as_text(header: Mapping[str, Any]) -> str:
    """Return a header as one line of JSON, in ASCII, with a check sum of each of its values."""
    return json.dumps({**header, SUMS: _sums(header)})


def of_text(text: str | bytes) -> dict[str, Any]:
    """Return the header in a file's JSON; InputError where it is of another version, or changed.

    Raises various exceptions where it is no header at all.
    """
    header: dict[str, Any] = json.loads(text)
    _check_format(header)
    check_sums(header, header["format"])
    return header


def check_sums(header: dict[str, Any], version: int) -> None:
    """Take the check sums out of a header. Raises InputError that names later changes.

    version: of the file; files of the former one may have none.
    """
    if SUMS not in header and version == FORMER_FORMAT:
        return
    stated, found = header.pop(SUMS, {}), _sums(header)
    changed = [name for name in found | stated if found.get(name) != stated.get(name)]
    if changed:
        raise InputError(f"damaged: {', '.join(changed[:3])} changed since it was saved")


def _sums(header: Mapping[str, Any]) -> dict[str, str]:
    texts = {name: json.dumps(value) for name, value in header.items() if name != SUMS}
    return {name: sha256(text.encode()).hexdigest()[:16] for name, text in texts.items()}


def columns_in(header: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the columns that every file of this version holds."""
    return COLUMNS if header["format"] == FORMAT else FORMER


def names_in(header: Mapping[str, Any]) -> list[str]:
    """Return the names of the columns that a file with this header holds."""
    contacts = [f"contact:{name}" for name in CONTACT.names or ()]
    messages = [*(f"message:{name}" for name in MESSAGE.names or ()), *TEXTS]
    sensors = [f"sensor:{name}" for name in header["sensor_robots"]]
    return [*columns_in(header), *contacts, *sensors, *(messages if header["messages"] else ())]


def names_of_bodies(header: Mapping[str, Any]) -> list[str]:
    """Return the names of the columns in a file that have a row for each time."""
    return [*columns_in(header), *(f"sensor:{name}" for name in header["sensor_robots"])]


def _check_format(header: Mapping[str, Any]) -> None:
    """Raise InputError for a file of another version, which says which MARS2D wrote it.

    Raises various exceptions where this is no header at all.
    """
    made = header["versions"].get("mars2d", "?")
    if type(header["format"]) is not int:
        raise TypeError("format")
    if header["format"] > FORMAT:
        raise InputError(f"written by a newer version of MARS2D, {made}: install that one to read")
    if header["format"] < FORMER_FORMAT:
        raise InputError(f"written by an older version of MARS2D, {made}: run the experiment again")


def restored(header: Mapping[str, Any], columns: Columns) -> Rows:
    """Put a record together from columns that lost their types or shapes; see `with_shapes`.

    columns: the values of each column of `numbers_of`, in order; a column without values may be
    missing. Raises the exceptions of `to_record`.
    """
    whole = {}
    for name in names_in(header):
        if name not in TEXTS:
            kind, shape = header["columns"][name]
            values = columns.get(name, np.empty(0)).reshape(shape)
            whole[name] = values.astype(kind, copy=False)
    texts = Texts.of(header["contents"])
    return to_record(header, {**whole, "contents": texts.data, "content_sizes": texts.sizes})


def to_record(header: Mapping[str, Any], columns: Columns, *, torn: bool = False) -> Rows:
    """Put a record together from the header and the columns of a file.

    columns: those of `names_in`, as `Record.columns` gives them. torn: whether the file breaks off,
    so that it states no digest. Raises InputError where the columns do not have the digest that the
    header states, and various exceptions where this is no record.
    """
    talked = header["messages"]
    lost: list[str] = []
    scenario, missing = serialize.to_scenario(pictures.of_record(header["scenario"], lost))
    robots = {name: tuple(indices) for name, indices in header["sensor_robots"].items()}
    record = Rows(
        scenario=scenario,
        seed=header["seed"],
        time=columns["time"],
        pose=columns["pose"],
        command=columns["command"],
        command_time=columns["command_time"],
        prop_pose=columns["prop_pose"],
        effort=columns["effort"],
        velocity=columns.get("velocity", NOT_KEPT),
        prop_velocity=columns.get("prop_velocity", NOT_KEPT),
        work=columns.get("work", NOT_KEPT),
        sensors={name: columns[f"sensor:{name}"] for name in robots},
        sensor_robots=robots,
        contacts=_rows(CONTACT, "contact", columns),
        messages=_rows(MESSAGE, "message", columns) if talked else np.zeros(0, MESSAGE),
        contents=_contents(columns) if talked else (),
        over_message=header["over_message"],
        finished=header["finished"],
        filename=header["filename"],
        versions=dict(header["versions"]),
        missing=(*missing, *dict.fromkeys(lost)),
        interventions=tuple(interventions.of_plain(each) for each in header["interventions"]),
        options={name: _tuples(value) for name, value in header.get("settings", {}).items()},
    )
    _check_shapes(record)
    if not torn and _digest(record, header) != header["digest"]:
        raise InputError("damaged: its columns do not have the digest that it states")
    return record


def _tuples(value: Any) -> Any:
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


def _digest(record: Rows, header: Mapping[str, Any]) -> str:
    """Return the digest of a record, as the version of its file has it."""
    without = set(COLUMNS) - set(columns_in(header))
    if not without:
        return record.digest
    columns = {name: each for name, each in record.columns().items() if name not in without}
    return digest_of(columns, record.over_message)


def _rows(dtype: np.dtype[Any], family: str, columns: Columns) -> NDArray[np.void]:
    """Return the contacts or messages whose fields a file holds one by one."""
    names = dtype.names or ()
    rows = np.zeros(len(columns[f"{family}:{names[0]}"]), dtype=dtype)
    for name in names:
        values = columns[f"{family}:{name}"]
        if values.dtype != rows[name].dtype or values.shape != rows[name].shape:
            raise ValueError(f"{family}:{name}: {values.dtype} {values.shape}")
        rows[name] = values
    return rows


def _contents(columns: Columns) -> tuple[str, ...]:
    text, sizes = columns["contents"].tobytes(), columns["content_sizes"]
    if sizes.ndim != 1 or sizes.dtype != np.int64 or (sizes < 0).any() or sizes.sum() != len(text):
        raise ValueError("content_sizes")
    ends = np.cumsum(sizes).tolist()
    return tuple(text[start:end].decode() for start, end in pairwise([0, *ends]))


def _check_shapes(record: Rows) -> None:
    """Raise ValueError for columns of wrong shapes or types."""
    rows, n, props = len(record.time), len(record.scenario.robots), len(record.scenario.props)
    shapes = [(rows,), (rows, 3, n), (rows, 2, n), (rows,), (rows, 3, props), (rows, n)]
    shapes += [(rows, 3, n), (rows, 3, props), (rows, len(WORK))]
    for name, shape in zip(COLUMNS, shapes, strict=True):
        column = getattr(record, name)
        if column.shape != shape or column.dtype != np.float64:
            raise ValueError(name)
    for name, values in record.sensors.items():
        robots = record.sensor_robots[name]
        if values.shape[:2] != (rows, len(robots)) or values.dtype not in (np.float64, np.bool_):
            raise ValueError(name)
