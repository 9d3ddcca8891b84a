"""``.mat``: one struct for Matlab and Octave, `out_data`, with the names of the MARS paper.

All numbers are doubles, flags are logical, and indices count from 1. MARS2D does not read it back.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.files import atomic_write
from mars2d.output.formats import header as headers
from mars2d.output.formats.columns import plain_names
from mars2d.record.rows import COLUMNS, Rows

NAME, STRUCT = "out_data", [("Vertex", object)]

INDICES = {"contact:a", "contact:b", "message:sender", "message:receiver", "message:content"}
"""Columns of indices from 0 on. Obstacles, whose indices are negative, count from -1 anyway."""


def write(record: Rows, path: Path) -> None:
    """Write a record to a file. Raises InputError where it can't be written."""
    from scipy.io import savemat

    sensors, out = plain_names(record.sensors), _looks(record)
    for name, column in headers.numbers_of(record).items():
        family, _, field = name.partition(":")
        if name in COLUMNS:
            group, field = "History", name.capitalize()
        elif family == "sensor":
            group, field = "Sensors", sensors[field]
        else:
            group = f"{family.capitalize()}s"
        values = column if column.dtype == np.bool_ else column.astype(np.float64)
        out.setdefault(group, {})[field] = values + (values >= 0) if name in INDICES else values
    header = headers.of_record(record) | {"contents": list(record.contents)}
    out |= {"Digest": record.digest, "Header": headers.as_text(header)}
    with atomic_write(path) as file:
        into: Any = file
        # By default names have at most 31 characters, as in Matlab before 2000.
        savemat(into, {NAME: out}, do_compression=True, long_field_names=True, oned_as="column")


def _looks(record: Rows) -> dict[str, Any]:
    """Return the fields of Table 1 of the paper except the history, and the names of all bodies."""
    scenario, robots = record.scenario, record.scenario.robots
    drives = [robot.drive for robot in robots]
    workspace, nothing, fields = scenario.workspace, float("nan"), plain_names(record.sensors)
    return {
        "Robots": float(len(robots)),
        "Initial_pose": scenario.initial_pose,
        "Sampling_time": scenario.sampling_time,
        "Stop_time": scenario.stop_time,
        "Workspace": np.array(workspace) if workspace else np.empty((0, 2)),
        "Bounds": np.array([scenario.bounds]),
        "Map": {"Obstacle": np.array([(np.array(o),) for o in scenario.obstacles], STRUCT)},
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
        "Seed": np.int64(record.seed),
        "Sensors": {},
        "Sensor_robots": {  # counted from 1
            fields[name]: np.array(robots) + 1.0 for name, robots in record.sensor_robots.items()
        },
    }


def _cell(texts: Iterable[str]) -> NDArray[Any]:
    return np.array([_text(each) for each in texts], dtype=object).reshape(-1, 1)


def _text(text: str) -> str:
    """Return a text with blanks at its end, so that it has as many characters as it had bytes.

    Octave reads as many bytes as a text has characters, and would cut off the rest.
    """
    return text + " " * (len(text.encode()) - len(text))
