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
from mars2d.record.contact import CONTACT
from mars2d.record.message import MESSAGE
from mars2d.record.rows import COLUMNS, Rows, shapes_of
from mars2d.scenario import serialize

Columns = Mapping[str, NDArray[Any]]

FORMAT = 5
"""The version of the contents of files; others are refused."""

SUMS = "sums"
"""The name of the check sums in a header."""

TEXTS = ("contents", "content_sizes")
"""The columns that are texts, which exports keep elsewhere."""


def of_record(record: Rows) -> dict[str, Any]:
    """Return everything in a record but its columns, as dicts, lists, text and numbers."""
    return {
        "format": FORMAT,
        "scenario": serialize.to_record(record.scenario),
        "seed": record.seed,
        "over_message": record.over_message,
        "finished": record.finished,
        "filename": record.filename,
        "versions": dict(record.versions),
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


def as_text(header: Mapping[str, Any]) -> str:
    """Return a header as one line of JSON, in ASCII, with a check sum of each of its values."""
    return json.dumps({**header, SUMS: _sums(header)})


def of_text(text: str | bytes) -> dict[str, Any]:
    """Return the header in a file's JSON; InputError where it is of another version, or changed.

    Raises various exceptions where it is no header at all.
    """
    header: dict[str, Any] = json.loads(text)
    made = header["versions"].get("mars2d", "?")
    if header["format"] > FORMAT:
        raise InputError(f"written by a newer version of MARS2D, {made}: install that one to read")
    if header["format"] < FORMAT:
        raise InputError(f"written by an older version of MARS2D, {made}: run the experiment again")
    check_sums(header)
    return header


def check_sums(header: dict[str, Any]) -> None:
    """Take the check sums out of a header. Raises InputError that names later changes."""
    stated, found = header.pop(SUMS, {}), _sums(header)
    changed = [name for name in found | stated if found.get(name) != stated.get(name)]
    if changed:
        raise InputError(f"damaged: {', '.join(changed[:3])} changed since it was saved")


def _sums(header: Mapping[str, Any]) -> dict[str, str]:
    texts = {name: json.dumps(value) for name, value in header.items() if name != SUMS}
    return {name: sha256(text.encode()).hexdigest()[:16] for name, text in texts.items()}


def to_record(header: Mapping[str, Any], columns: Columns, *, torn: bool = False) -> Rows:
    """Put a record together from the header and the columns of a file.

    columns: as `Record.columns` gives them. torn: whether the file breaks off, so that it states no
    digest. Raises InputError where the columns do not have the digest that the
    header states, and various exceptions where this is no record.
    """
    talked = "contents" in columns
    scenario, missing = serialize.of_record(header["scenario"])
    robots = {name: tuple(indices) for name, indices in header["sensor_robots"].items()}
    series: dict[str, Any] = {name: columns[name] for name in COLUMNS}
    record = Rows(
        scenario=scenario,
        seed=header["seed"],
        **series,
        sensors={name: columns[f"sensor:{name}"] for name in robots},
        sensor_robots=robots,
        contacts=_rows(CONTACT, "contact", columns),
        messages=_rows(MESSAGE, "message", columns) if talked else np.zeros(0, MESSAGE),
        contents=_contents(columns) if talked else (),
        over_message=header["over_message"],
        finished=header["finished"],
        filename=header["filename"],
        versions=dict(header["versions"]),
        missing=missing,
        interventions=tuple(interventions.of_plain(each) for each in header["interventions"]),
        options={name: _tuples(value) for name, value in header.get("settings", {}).items()},
    )
    _check_shapes(record)
    if not torn and record.digest != header["digest"]:
        raise InputError("damaged: its columns do not have the digest that it states")
    return record


def _tuples(value: Any) -> Any:
    return tuple(map(_tuples, value)) if isinstance(value, list) else value


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
    scenario, inputs = record.scenario, [*record.command.shape, 0][1]
    shapes = shapes_of(len(scenario.robots), len(scenario.props), inputs)
    for name in COLUMNS:
        column = getattr(record, name)
        if column.shape != (len(record), *shapes[name]) or column.dtype != np.float64:
            raise ValueError(name)
    for name, values in record.sensors.items():
        robots = record.sensor_robots[name]
        if values.shape[:2] != (len(record), len(robots)) or values.dtype not in (float, bool):
            raise ValueError(name)
