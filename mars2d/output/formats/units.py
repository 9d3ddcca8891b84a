"""In which units the columns of a record are, as tables and datasets say beside them."""

from __future__ import annotations

from mars2d.record.record import Record

__all__ = [
    "COLUMN_UNITS",
    "CONTACT_UNITS",
    "MESSAGE_UNITS",
    "POSE_UNITS",
    "command_units",
    "sensor_units",
]

POSE_UNITS = {"x": "m", "y": "m", "theta": "rad"}
"""Those of a pose, by the names of its parts, in order."""

COLUMN_UNITS = {"time": "s", "command_time": "s", "effort": "1"}
"""Those of other columns that have one unit."""

CONTACT_UNITS = {
    "time": "s", "duration": "s", "point": "m", "normal": "1", "impulse": "N s",
    "normal_impulse": "N s", "tangential_impulse": "N s", "speed": "m/s", "slip": "m/s",
}  # fmt: skip
"""Those of the fields of contacts; the others are indices and flags."""

MESSAGE_UNITS = {"time": "s", "arrival": "s", "size": "byte"}


def command_units(record: Record) -> tuple[str, ...]:
    """Return the units of the two numbers of a command; () where robots' drives differ in them.

    The same for drives of the user's own that do not say.
    """
    drives = (robot.drive for robot in record.scenario.robots)
    found = {tuple(quantity.unit for quantity in drive.quantities) for drive in drives}
    return found.pop() if len(found) == 1 else ()


def sensor_units(record: Record, name: str) -> tuple[str, ...] | None:
    """Return the units of what a sensor measures, in order; None without any, or none known.

    The latter holds for sensors of the user's own in a record that was read from a file.
    """
    found = {
        tuple(quantity.unit for quantity in sensor.quantities)
        for robot in record.sensor_robots[name]
        if (sensor := record.scenario.robots[robot].sensor(name)) is not None
    }
    units = found.pop() if len(found) == 1 else ()
    return tuple(unit or "1" for unit in units) if any(units) else None
