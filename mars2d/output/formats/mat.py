"""``.mat``: one struct for Matlab and Octave, `out_data`, with the names of the MARS paper.

All numbers are doubles, flags are logical, and indices count from 1.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator, Mapping
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.output.formats import header as headers
from mars2d.output.formats.columns import plain_names
from mars2d.output.formats.guard import check_size, in_bytes, reading
from mars2d.record.record import Record

NAME = "out_data"

MAX_SIZE = 2**31 - 2**20
"""The most data in a file, bytes: Matlab and Octave open structs of up to 2 GB, header included."""

HISTORY = {
    "time": "Time", "pose": "Pose", "command": "Command", "command_time": "Command_time",
    "prop_pose": "Prop_pose", "effort": "Effort", "velocity": "Velocity",
    "prop_velocity": "Prop_velocity", "work": "Work",
}  # fmt: skip

INDICES = {"contact:a", "contact:b", "message:sender", "message:receiver", "message:content"}
"""Columns of indices from 0 on. Obstacles, whose indices are negative, count from -1 anyway."""


def write(record: Record, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written."""
    from scipy.io import savemat

    columns = headers.numbers_of(record)
    size = sum(8 * column.size for column in columns.values())
    if size > MAX_SIZE:
        raise InputError(
            f"{path}: can't be written: {in_bytes(size)} are more than Matlab reads from a .mat, "
            "2 GB: save it as .npz"
        )
    header, out = headers.with_shapes(record), _looks(record)
    for name, (group, field) in _places(header).items():
        out.setdefault(group, {})[field] = _for_matlab(name, columns[name])
    out |= {"Digest": record.digest, "Header": headers.as_text(header)}
    with atomic_write(path) as file:
        into: Any = file
        # By default names have at most 31 characters, as in Matlab before 2000.
        savemat(into, {NAME: out}, do_compression=True, long_field_names=True, oned_as="column")


def read(path: Path, largest: int) -> Record:
    """Read the record in a file; InputError where there is none, or it is larger than allowed."""
    with reading(path):
        out = read_struct(path, NAME, largest)
        header = headers.of_text(path, out["Header"], largest)
        places, shapes = _places(header), header["columns"]
        columns = {
            name: _of_matlab(name, out[group][field], shapes[name][1])
            for name, (group, field) in places.items()
        }
        return headers.restored(header, columns)


def _places(header: Mapping[str, Any]) -> dict[str, tuple[str, str]]:
    """Return for each column the struct that holds it, and the field."""
    sensors = plain_names(header["sensor_robots"])
    places = {}
    for name in headers.names_in(header):
        family, _, field = name.partition(":")
        if name in HISTORY:
            places[name] = ("History", HISTORY[name])
        elif family == "sensor":
            places[name] = ("Sensors", sensors[field])
        elif name not in headers.TEXTS:
            places[name] = (f"{family.capitalize()}s", field)
    return places


def _for_matlab(name: str, column: NDArray[Any]) -> NDArray[Any]:
    values = column if column.dtype == np.bool_ else column.astype(np.float64)
    return values + (values >= 0) if name in INDICES else values


def _of_matlab(name: str, values: NDArray[Any], shape: list[int]) -> NDArray[Any]:
    """Return a column in its own shape: Matlab has at least two axes, and drops last axes of 1."""
    if name in INDICES:
        values = values.astype(np.float64)
        values = values - (values > 0)
    return values.reshape(shape, order="F")


def _looks(record: Record) -> dict[str, Any]:
    """Return the fields of Table 1 of the paper except the history, and the names of all bodies."""
    scenario, robots = record.scenario, record.scenario.robots
    drives = [robot.drive for robot in robots]
    animation, workspace = scenario.animation, scenario.workspace
    nothing = float("nan")
    return {
        "Robots": float(len(robots)),
        "Initial_pose": scenario.initial_pose,
        "Sampling_time": scenario.sampling_time,
        "Stop_time": scenario.stop_time,
        "Workspace": np.array(workspace) if workspace else np.empty((0, 2)),
        "Bounds": np.array([scenario.bounds]),
        "Non_holonomic": np.array([[not drive.holonomic for drive in drives]]),
        "Command_delay": scenario.command_delay,
        "Exp_over": record.finished,
        "Exp_over_msg": _text(record.over_message),
        "Filename": _text(record.filename),
        "Version": _text(record.versions.get("mars2d", "")),
        "Addons": _cell(addon.key for addon in scenario.addons),
        "Robot": {
            "Name": _cell(str(robot.name) for robot in robots),
            "Drive": _cell(type(drive).__name__ for drive in drives),
            "Max_linear_speed": np.array([[drive.max_linear_speed for drive in drives]]),
            "Wheels_semiaxis_length": np.array(
                [[getattr(drive, "wheel_semiaxis", nothing) for drive in drives]]
            ),
            "Diameter": np.array([[2 * robot.radius for robot in robots]]),
            "Distance_center_barycenter": np.array([[robot.center_offset for robot in robots]]),
        },
        "Prop": {"Name": _cell(str(prop.name) for prop in scenario.props)},
        "Animation": {
            "Title": _text(scenario.title),
            "Grid": animation.grid,
            "Show_initial_pose": animation.show_initial_pose,
            "Show_real_shape": animation.show_real_shape,
            "Wake": animation.wake,
            "Wake_style": animation.wake_style,
            "Playback_speed": animation.playback_speed,
            "Base_colors": _cell(animation.base_colors),
        },
        "Seed": np.int64(record.seed),
        "Sensors": {},
        "Sensor_robots": _carriers(record),
    }


def _carriers(record: Record) -> dict[str, Any]:
    """Return for each sensor the robots that carry it, counted from 1."""
    fields = plain_names(record.sensors)
    return {fields[name]: np.array(record.sensor_robots[name]) + 1.0 for name in fields}


def _cell(texts: Iterable[str]) -> NDArray[Any]:
    return np.array([_text(each) for each in texts], dtype=object).reshape(-1, 1)


def _text(text: str) -> str:
    """Return a text with blanks at its end, so that it has as many characters as it had bytes.

    Octave reads as many bytes as a text has characters, and would cut off the rest.
    """
    return text + " " * (len(text.encode()) - len(text))


# -- MAT-files of level 5 -------------------------------------------------------------------------

HEAD_SIZE = 128
"""The length of a file's head, bytes: a sentence, the version, the byte order."""

MATRIX, COMPRESSED = 14, 15

STRUCT, CHAR, NUMBERS = 2, 4, range(6, 16)
"""The classes of arrays that are read; cells, objects, sparse arrays and functions are not."""

COMPLEX = 0x08

KINDS = {1: "<i1", 2: "<u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 9: "<f8",
         12: "<i8", 13: "<u8"}  # fmt: skip
"""The types in which numbers are stored, which may be shorter than the array's class."""

ENCODINGS = {4: "utf-16-le", 17: "utf-16-le", 18: "utf-32-le"}
"""The encodings of texts by their type; all others are UTF-8."""


def read_struct(path: Path, name: str, largest: int) -> dict[str, Any]:
    """Return the struct of a name in a file: arrays, text and structs by the names of its fields.

    Fields of other classes are None. Raises InputError for other formats of Matlab and Octave and
    for more than `largest` bytes, and various exceptions for a damaged file.
    """
    check_size(path, path.stat().st_size, largest)
    content = memoryview(path.read_bytes())
    _check_head(bytes(content[:HEAD_SIZE]))
    at = HEAD_SIZE
    while at < len(content):
        kind, data, at = _element(content, at, padded=False)
        if kind == COMPRESSED:
            kind, data = _expanded(path, data, largest)
        found, value = _array(data) if kind == MATRIX else ("", None)
        if found == name and isinstance(value, dict):
            return value
    raise InputError(f"{path}: holds no struct {name!r}, as records of MARS2D do")


def _check_head(head: bytes) -> None:
    if b"MATLAB 7.3" in head or head.startswith(b"\x89HDF"):
        raise InputError("a Matlab file of version 7.3; expected one of 'save -v7'")
    if head.startswith((b"# Created by Octave", b"Octave-1")):
        raise InputError("a file of Octave's own format; expected one of 'save -v7'")
    if head[124:128] != b"\x00\x01IM":
        raise ValueError("no MAT-file of level 5, little end first")


def _expanded(path: Path, data: memoryview, largest: int) -> tuple[int, memoryview]:
    """Return the element in a compressed one. Raises ValueError if its size isn't as stated."""
    stream = zlib.decompressobj()
    kind, size = struct.unpack("<II", stream.decompress(data, 8))
    check_size(path, size, largest)
    inside = stream.decompress(stream.unconsumed_tail, size + 1)
    if len(inside) != size or not stream.eof:
        raise ValueError("compressed data")
    return kind, memoryview(inside)


def _element(data: memoryview, at: int, padded: bool = True) -> tuple[int, memoryview, int]:
    """Return the kind of the element at a place, its bytes, and the place of the next one."""
    (kind,) = struct.unpack_from("<I", data, at)
    if kind >> 16:  # a small element: the upper half is its size
        kind, size, start, end = kind & 0xFFFF, kind >> 16, at + 4, at + 8
    else:
        (size,) = struct.unpack_from("<I", data, at + 4)
        start = at + 8
        end = start + size + (-size % 8 if padded else 0)
    inside = data[start : start + size]
    if len(inside) != size or start + size > end:
        raise ValueError("an element is cut off")
    return kind, inside, end


def _elements(data: memoryview) -> Iterator[tuple[int, memoryview]]:
    at = 0
    while at < len(data):
        kind, inside, at = _element(data, at)
        yield kind, inside


def _array(data: memoryview) -> tuple[str, Any]:
    """Return the name and the value of an array; the value is None if its class is not read."""
    if not len(data):
        return "", np.empty((0, 0))
    parts = _elements(data)
    flags = next(parts)[1]
    shape = tuple(np.frombuffer(next(parts)[1], "<i4").tolist())
    name = bytes(next(parts)[1]).decode()
    if flags[0] == STRUCT and prod(shape) == 1:
        return name, _fields(parts)
    if flags[0] == CHAR:
        kind, text = next(parts, (0, b""))
        return name, bytes(text).decode(ENCODINGS.get(kind, "utf-8"), "replace")
    if flags[0] in NUMBERS and not flags[1] & COMPLEX:
        kind, values = next(parts)
        return name, np.frombuffer(values, KINDS[kind]).reshape(shape, order="F")
    return name, None


def _fields(parts: Iterator[tuple[int, memoryview]]) -> dict[str, Any]:
    (width,) = struct.unpack("<i", next(parts)[1])
    names = bytes(next(parts)[1])
    if width < 1:
        raise ValueError("names of fields")
    keys = [names[i : i + width].split(b"\0")[0].decode() for i in range(0, len(names), width)]
    return {key: _array(next(parts)[1])[1] for key in keys}
