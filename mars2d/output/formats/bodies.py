"""The long table of a record: one row for each time and body, robots first, then props."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from mars2d.output.formats.units import POSE_UNITS

__all__ = ["AXES", "FIRST", "INPUTS", "LAST", "Part", "parts_of"]

FIRST, LAST = ("time", "body"), "record"
"""How rows are told apart; and what a file has after all columns."""

AXES = tuple(POSE_UNITS)

INPUTS = ("command_0", "command_1")


class Part(NamedTuple):
    """Where values of a column of the table are in the record: those of some of the bodies.

    name: the record's column. at: what it is indexed by after its rows, to have one value for
    each of the `bodies`, which are counted in the order of the table.
    """

    name: str
    at: tuple[Any, ...]
    bodies: tuple[int, ...]


def parts_of(
    robots: int,
    props: int,
    sensor_robots: Mapping[str, Sequence[int]],
    shapes: Mapping[str, Sequence[int]],
) -> dict[str, list[Part]]:
    """Return the table's columns by name, after time and body: each has one part or two.

    shapes: those of all readings of each sensor, (T, m, ...). A reading that is an array has a
    column for each value, as ``scan_0`` or ``grid_0_1``. A name that another column has ends in _.
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
    taken = {*FIRST, *found, LAST}
    for sensor in sensor_robots:
        for place in np.ndindex(*shapes[sensor][2:]):
            name = "_".join([sensor, *map(str, place)])
            while name in taken:
                name += "_"
            taken.add(name)
            part = Part(f"sensor:{sensor}", (every, *place), tuple(sensor_robots[sensor]))
            found[name] = [part]
    return found
