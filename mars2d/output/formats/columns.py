"""How files and tables for other programs name, measure and arrange a record's columns."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from mars2d.core.quantity import Quantity
from mars2d.record.energy import WORK
from mars2d.record.rows import Rows

# -- axes and units ---------------------------------------------------------------------------


class About(NamedTuple):
    """What a column of a record is.

    units: of what is along the first axis of its rows; of a command they depend on the drives.
    """

    units: tuple[str, ...]
    meaning: str


METRES, SPEEDS = ("m", "m", "rad"), ("m/s", "m/s", "rad/s")

ABOUT = {
    "time": About(("s",), "time"),
    "pose": About(METRES, "poses of the robots: x, y, heading"),
    "command": About((), "commands issued"),
    "command_time": About(("s",), "when the command takes effect"),
    "prop_pose": About(METRES, "poses of the props: x, y, heading"),
    "effort": About(("1",), "largest share of its bounds that a drive used in the step before"),
    "velocity": About(SPEEDS, "velocities of the robots: x, y, heading"),
    "prop_velocity": About(SPEEDS, "velocities of the props: x, y, heading"),
    "work": About(("J",), "work on all bodies since the start"),
}
"""By name: all of `COLUMNS`."""

POSE_UNITS = dict(zip(("x", "y", "theta"), METRES, strict=True))
"""The units of a pose's three numbers, in order."""


CONTACT_UNITS = {
    "time": "s", "duration": "s", "point": "m", "normal": "1", "impulse": "N s",
    "normal_impulse": "N s", "tangential_impulse": "N s", "speed": "m/s", "slip": "m/s",
}  # fmt: skip
"""The units of the fields of contacts; the other fields are indices and flags."""

MESSAGE_UNITS = {"time": "s", "arrival": "s", "size": "byte"}
"""The units of the fields of messages; the other fields are indices."""


def units_in(record: Rows, column: str) -> tuple[str, ...]:
    """Return the units in a column of `COLUMNS` or of readings: one, or those along an axis.

    () where the robots' drives disagree, and where units are unknown, as those of drives and
    sensors of the user's own that do not say.
    """
    robots = record.scenario.robots
    _, of_sensor, name = column.partition(":")
    if of_sensor:
        sensors = [robots[robot].sensor(name) for robot in record.sensor_robots[name]]
        found = {_units(sensor.quantities) for sensor in sensors if sensor is not None}
    elif column == "command":
        found = {_units(robot.drive.inputs) for robot in robots}
    else:
        return ABOUT[column].units
    return found.pop() if len(found) == 1 else ()


def _units(quantities: Iterable[Quantity]) -> tuple[str, ...]:
    units = [quantity.unit for quantity in quantities]
    return tuple(unit or "1" for unit in units) if any(units) else ()


# -- names ------------------------------------------------------------------------------------

MAX_NAME = 63
"""The most characters in the name of a field in Matlab."""


def plain_names(names: Iterable[str]) -> dict[str, str]:
    """Map each name to one that Matlab accepts: ASCII, a letter first, at most 63 characters.

    Where two would be equal, the later one ends in its number.

    >>> plain_names(["scan", "größe", "gr_ße"])
    {'scan': 'scan', 'größe': 'gr__e', 'gr_ße': 'gr__e_2'}
    """
    found: dict[str, str] = {}
    for k, name in enumerate(names):
        plain = re.sub("[^A-Za-z0-9_]", "_", name)
        plain = (plain if plain[:1].isalpha() else f"x{plain}")[:MAX_NAME]
        found[name] = f"{plain[: MAX_NAME - 4]}_{k}" if plain in found.values() else plain
    return found


# -- the long table: a row for each time and body, robots first, then props -------------------

KEYS = ("time", "body")
"""The first columns of the table, which tell its rows apart."""

LAST = "record"
"""The column that a file has after all others, for everything that is not in the table."""


class Part(NamedTuple):
    """Where the values of a column of the table are in the record, for some of the bodies.

    name: the column of the record. at: the index after its rows, which gives one value for each of
    the `bodies`. Bodies are numbered in the order of the table.
    """

    name: str
    at: tuple[Any, ...]
    bodies: tuple[int, ...]


def parts_of(record: Rows) -> dict[str, list[Part]]:
    """Return the table's columns after time and body, by name; each has one part or two.

    A reading that is an array has a column for each of its values, for example ``scan_0`` or
    ``grid_0_1``. A sensor's column whose name is taken gets an underscore at its end.
    """
    robots, bodies = len(record.scenario.robots), len(record.scenario.bodies)
    teams, others, every = tuple(range(robots)), tuple(range(robots, bodies)), slice(None)
    axes = list(enumerate(POSE_UNITS))
    found = {
        axis: [Part("pose", (k, every), teams), Part("prop_pose", (k, every), others)]
        for k, axis in axes
    }
    inputs = range(record.command.shape[1])
    found |= {f"command_{k}": [Part("command", (k, every), teams)] for k in inputs}
    found["command_time"] = [Part("command_time", (None,), teams)]
    found["effort"] = [Part("effort", (every,), teams)]
    found |= {
        f"v{axis}": [Part("velocity", (k, every), teams), Part("prop_velocity", (k, every), others)]
        for k, axis in axes
    }
    found |= {f"work_{name}": [Part("work", (k, None), teams)] for k, name in enumerate(WORK)}
    taken = {*KEYS, *found, LAST}
    for sensor, values in record.sensors.items():
        for place in np.ndindex(*values.shape[2:]):
            name = "_".join([sensor, *map(str, place)])
            while name in taken:
                name += "_"
            taken.add(name)
            carriers = tuple(record.sensor_robots[sensor])
            found[name] = [Part(f"sensor:{sensor}", (every, *place), carriers)]
    return found
