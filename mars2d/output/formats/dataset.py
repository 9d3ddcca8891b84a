"""Datasets of xarray: all columns of a record, with named axes and units."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.extras import extra
from mars2d.output.formats import header as headers
from mars2d.output.formats.columns import (
    ABOUT,
    CONTACT_UNITS,
    MESSAGE_UNITS,
    POSE_UNITS,
    units_in,
)
from mars2d.record.energy import WORK
from mars2d.record.message import STATUS
from mars2d.record.rows import COLUMNS, Rows

if TYPE_CHECKING:
    from xarray import Dataset

HEADER = "mars2d"
"""The attribute that holds a record's header, as JSON."""


def to_xarray(record: Rows) -> Dataset:
    """Return all columns of a record as a dataset, with units as attributes.

    ``pose``: time, axis (x, y, theta), robot. ``command``: time, input, robot. ``prop_pose``: time,
    axis, prop. ``effort``: time, robot. ``velocity`` and ``prop_velocity``: as the poses. ``work``:
    time, work_of. ``sensor_NAME``: time, robot, and ``NAME_0`` and so on for
    the axes of a reading; ``NAME_robot`` in place of robot where not all carry it.
    ``contact_FIELD``: contact. ``message_FIELD``: message; ``contents``: content, the texts. The
    attributes have title, seed, digest, why it ended and, as JSON, the rest. What has no values is
    left out, since a length of 0 means in netCDF 3 that a dimension can grow. Raises
    MissingExtraError without xarray.
    """
    with extra("data", "datasets need xarray"):
        import xarray as xr
    scenario = record.scenario
    names = [str(robot.name) for robot in scenario.robots]
    places: dict[str, Any] = {
        "axis": list(POSE_UNITS),
        "robot": np.array(names, dtype=object),
        "prop": np.array([str(prop.name) for prop in scenario.props], dtype=object),
        "work_of": list(WORK),
    }
    for name, robots in record.sensor_robots.items():
        if len(robots) < len(names):
            carriers = [names[robot] for robot in robots]
            places[f"{name}_robot"] = np.array(carriers, dtype=object)
    variables: dict[str, Any] = {
        variable: (dimensions, column, {"long_name": long_name} | ({"units": unit} if unit else {}))
        for name, column in headers.numbers_of(record).items()
        if column.size
        for variable, dimensions, unit, long_name in [_told(record, name)]
    }
    places = {name: place for name, place in places.items() if len(place)}
    places["time"] = variables.pop("time", [])
    if record.contents:
        texts = np.array(record.contents, dtype=object)
        about = {"long_name": "what was sent, as JSON; message_content counts it from 0"}
        variables["contents"] = (("content",), texts, about)
    about = {
        "title": scenario.title,
        "source": f"MARS2D {record.versions.get('mars2d', '')}".strip(),
        "seed": str(record.seed),  # netCDF has no whole numbers so large
        "digest": record.digest,
        "over_message": record.over_message,
        HEADER: headers.as_text(headers.of_record(record)),
    }
    return xr.Dataset(variables, coords=places, attrs=about)


def _told(record: Rows, column: str) -> tuple[str, tuple[str, ...], str, str]:
    """Return the name of a column's variable, its dimensions, its unit and its long name."""
    if column in ABOUT:
        units = ", ".join(units_in(record, column))
        return column, ("time", *COLUMNS[column]), units, ABOUT[column].meaning
    family, _, name = column.partition(":")
    if family == "sensor":
        all_carry = len(record.sensor_robots[name]) == len(record.scenario.robots)
        others = (f"{name}_{k}" for k in range(record.sensors[name].ndim - 2))
        dimensions = ("time", "robot" if all_carry else f"{name}_robot", *others)
        units = ", ".join(units_in(record, column))
        return f"sensor_{name}", dimensions, units, f"sensor {name}".replace("_", " ")
    long_name = f"{family} {name}".replace("_", " ")
    if column == "message:status":
        long_name = ", ".join(f"{k} {word}" for k, word in enumerate(STATUS))
    unit = (CONTACT_UNITS if family == "contact" else MESSAGE_UNITS).get(name, "")
    dimensions = (family, "xy") if name in ("point", "normal") else (family,)
    return f"{family}_{name}", dimensions, unit, long_name
