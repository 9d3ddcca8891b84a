"""How files and tables for other programs name, measure and arrange a record's columns."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from mars2d.record.energy import WORK
from mars2d.record.rows import COLUMNS, Rows

# -- units ------------------------------------------------------------------------------------

POSE_UNITS = {"x": "m", "y": "m", "theta": "rad"}
"""The units of a pose's three numbers, in order."""

COLUMN_UNITS = {"time": "s", "command_time": "s", "effort": "1", "work": "J"}
"""The units of the other columns that have one unit."""

CONTACT_UNITS = {
    "time": "s", "duration": "s", "point": "m", "normal": "1", "impulse": "N s",
    "normal_impulse": "N s", "tangential_impulse": "N s", "speed": "m/s", "slip": "m/s",
}  # fmt: skip
"""The units of the fields of contacts; the other fields are indices and flags."""

MESSAGE_UNITS = {"time": "s", "arrival": "s", "size": "byte"}
"""The units of the fields of messages; the other fields are indices."""


def command_units(record: Rows) -> tuple[str, ...]:
    """Return the units of a command's two numbers; () where the robots' drives disagree.

    It is () as well for drives of the user's own that do not say.
    """
    drives = (robot.drive for robot in record.scenario.robots)
    found = {tuple(quantity.unit for quantity in drive.quantities) for drive in drives}
    return found.pop() if len(found) == 1 else ()


def sensor_units(record: Rows, name: str) -> tuple[str, ...] | None:
    """Return the units of a sensor's readings, in order; None where it has none.

    None, too, where they are unknown: for sensors of the user's own in a record from a file.
    """
    found = {
        tuple(quantity.unit for quantity in sensor.quantities)
        for robot in record.sensor_robots[name]
        if (sensor := record.scenario.robots[robot].sensor(name)) is not None
    }
    units = found.pop() if len(found) == 1 else ()
    return tuple(unit or "1" for unit in units) if any(units) else None


# -- names ------------------------------------------------------------------------------------

MAX_NAME = 63
"""The most characters in the name of a field in Matlab."""

KEYWORDS = {
    "case", "catch", "end", "function", "otherwise", "parfor", "persistent", "spmd", "switch",
}  # fmt: skip
"""Reserved words of Matlab that are names in Python, so that a sensor may be called so."""


def plain_names(names: Iterable[str]) -> dict[str, str]:
    """Map each name to one that Matlab accepts: ASCII, a letter first, at most 63 characters.

    Where two would be equal, the later one ends in a number.

    >>> plain_names(["scan", "größe", "gr_ße", "end"])
    {'scan': 'scan', 'größe': 'gr__e', 'gr_ße': 'gr__e_2', 'end': 'xend'}
    """
    found: dict[str, str] = {}
    for name in names:
        plain = re.sub("[^A-Za-z0-9_]", "_", name)
        if not plain[:1].isalpha() or plain in KEYWORDS:
            plain = f"x{plain}"
        free, k = plain[:MAX_NAME], 1
        while free in found.values():
            k += 1
            free = f"{plain[: MAX_NAME - len(f'_{k}')]}_{k}"
        found[name] = free
    return found


# -- the long table: a row for each time and body, robots first, then props -------------------

KEYS = ("time", "body")
"""The first columns of the table, which tell its rows apart."""

LAST = "record"
"""The column that a file has after all others, for everything that is not in the table."""

AXES = tuple(POSE_UNITS)

INPUTS = ("command_0", "command_1")


class Part(NamedTuple):
    """Where the values of a column of the table are in the record, for some of the bodies.

    name: the column of the record. at: the index after its rows, which gives one value for each of
    the `bodies`. Bodies are numbered in the order of the table.
    """

    name: str
    at: tuple[Any, ...]
    bodies: tuple[int, ...]


def parts_of(
    robots: int,
    props: int,
    sensor_robots: Mapping[str, Sequence[int]],
    shapes: Mapping[str, Sequence[int]],
    columns: Sequence[str] = COLUMNS,
) -> dict[str, list[Part]]:
    """Return the table's columns after time and body, by name; each has one part or two.

    shapes: for each sensor that of all its readings, (T, m, ...). columns: those that there are. A
    reading that is an array has a column for each of its values, for example ``scan_0`` or
    ``grid_0_1``. A sensor's column whose name is taken gets an underscore at its end.
    """
    teams, others = tuple(range(robots)), tuple(range(robots, robots + props))
    every = slice(None)
    found = {
        axis: [Part("pose", (k, every), teams), Part("prop_pose", (k, every), others)]
        for k, axis in enumerate(AXES)
    }
    found |= {name: [Part("command", (k, every), teams)] for k, name in enumerate(INPUTS)}
    found["command_time"] = [Part("command_time", (None,), teams)]
    found["effort"] = [Part("effort", (every,), teams)]
    found |= {
        f"v{axis}": [Part("velocity", (k, every), teams), Part("prop_velocity", (k, every), others)]
        for k, axis in enumerate(AXES)
    }
    found |= {f"work_{name}": [Part("work", (k, None), teams)] for k, name in enumerate(WORK)}
    found = {name: parts for name, parts in found.items() if parts[0].name in columns}
    taken = {*KEYS, *found, LAST}
    for sensor in sensor_robots:
        for place in np.ndindex(*shapes[sensor][2:]):
            name = "_".join([sensor, *map(str, place)])
            while name in taken:
                name += "_"
            taken.add(name)
            part = Part(f"sensor:{sensor}", (every, *place), tuple(sensor_robots[sensor]))
            found[name] = [part]
    return found
