"""What the sensors of a record have seen, as columns of a replay."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.output.pages.replay.columns import Columns, Int, rounded
from mars2d.output.pages.replay.drawings import Drawing
from mars2d.output.pages.replay.shapes import Flat, Float, flat, moved
from mars2d.sensors.base import Sensor
from mars2d.sensors.range_finder import RangeFinder
from mars2d.sensors.sonar_ring import SonarRing

if TYPE_CHECKING:
    from mars2d.record.record import Record

__all__ = [
    "Carried",
    "Fan",
    "beams_left_out",
    "carried",
    "drawings",
    "fans_of",
    "pack_fans",
    "pack_readings",
]

WORDS = 8
"""Readings of so many numbers are said in words."""

SELDOM = 8
"""What a sensor draws so seldom is kept each time, however many others there are."""

BEAMS = 360
"""Of a sensor's beams, so many are drawn."""

DRAWN = 5000
"""So many readings are drawn by the sensors themselves."""

LEVELS = 254
"""Distances are rounded to the range over this; one more level says that nothing is there."""

ELSEWHERE = np.array([0.7, -0.4, 1.1])
"""A pose that tells what is drawn in a robot's frame from what is drawn in that of the world."""


class Carried:
    """A sensor on a robot, and what it read at the rows of a replay, (R, ...)."""

    def __init__(self, name: str, robot: int, sensor: Sensor, readings: NDArray[Any]) -> None:
        """Keep them together."""
        self.name, self.robot, self.sensor, self.readings = name, robot, sensor, readings

    def changes(self) -> Int:
        """Return the rows at which it reads something else than at the row before."""
        if not len(self.readings):
            return np.empty(0, dtype=np.int64)
        bits = np.ascontiguousarray(self.readings).view(np.uint8).reshape(len(self.readings), -1)
        changed = np.any(bits[1:] != bits[:-1], axis=1)
        return np.concatenate([[0], np.flatnonzero(changed) + 1])


class Fan(Carried):
    """One that reads distances along beams, which need no shapes."""

    sensor: RangeFinder | SonarRing


def carried(record: Record, kept: Int) -> Iterator[Carried]:
    """Yield the sensors of a record that are known; a loaded one lacks those of the user's own."""
    for name, robots in record.sensor_robots.items():
        for k, robot in enumerate(robots):
            sensor = record.scenario.robots[robot].sensor(name)
            if sensor is not None:
                readings = record.sensors[name][kept, k]
                yield (Fan if _is_fan(sensor, readings) else Carried)(name, robot, sensor, readings)


def _is_fan(sensor: Sensor, readings: NDArray[Any]) -> bool:
    """Return whether a sensor reads distances along beams, and is drawn as those are."""
    if not isinstance(sensor, (RangeFinder, SonarRing)):
        return False
    own = type(sensor) not in (RangeFinder, SonarRing)  # the user's, which may draw something else
    beams = readings.shape[1:] == np.shape(sensor.angles)
    return beams and readings.dtype.kind == "f" and not own


def fans_of(fans: list[Fan]) -> list[dict[str, Any]]:
    """Return what has to be known of sensors that read distances along beams."""
    found = []
    for each in fans:
        sensor, angles = each.sensor, np.asarray(each.sensor.angles)
        skip = _skip(len(angles))
        found.append({
            "name": each.name,
            "robot": each.robot,
            "range": sensor.range,
            "mount": list(sensor.mount),
            "first": float(angles[0]),
            "apart": float(angles[1] - angles[0]) * skip if len(angles) > 1 else 0.0,
            "beams": len(angles[::skip]),
            "cone": sensor.cone if isinstance(sensor, SonarRing) else 0.0,
            "closed": sensor.field_of_view >= 2 * np.pi and len(angles) > 2,
        })  # fmt: skip
    return found


def pack_fans(fans: list[Fan], every: int) -> tuple[Columns, int]:
    """Return the distances of all fans at each so-manieth row, a byte each."""
    columns = Columns()
    rows = np.arange(0, len(fans[0].readings), every)
    levels = []
    for each in fans:
        far = each.readings[rows][:, :: _skip(each.readings.shape[1])]
        share = far / each.sensor.range
        near = np.isfinite(far)
        level = np.rint(LEVELS * np.clip(np.where(near, share, 0.0), 0, 1)).astype(np.uint8)
        levels.append(np.where(near, level, LEVELS + 1).astype(np.uint8))
    columns.add_bytes("fans", np.concatenate(levels, axis=1), every=every)
    return columns, len(rows)


def beams_left_out(fans: list[Fan]) -> list[str]:
    """Return for each kind of scanner of too many beams, in words, how many of them are drawn."""
    skips = {each.name: _skip(each.readings.shape[1]) for each in fans}
    return [f"beams of {name}: one in {skip}" for name, skip in skips.items() if skip > 1]


def _skip(beams: int) -> int:
    return -(-beams // BEAMS)


def drawings(
    sensors: list[Carried], pose: Float, colors: tuple[str, ...]
) -> tuple[list[Drawing], int]:
    """Return what sensors draw of their readings, and of how many rows in a row one is drawn.

    pose: (R, 3, n), of the rows of a replay.
    """
    changes = [each.changes() for each in sensors]
    stride = 1
    while sum(len(np.unique(rows // stride)) for rows in changes if len(rows) > SELDOM) > DRAWN:
        stride *= 2
    found = [
        _drawing(each, rows if len(rows) <= SELDOM else _last(rows, stride), pose, colors)
        for each, rows in zip(sensors, changes, strict=True)
    ]
    return found, stride


def _last(rows: Int, stride: int) -> Int:
    """Return the last row of each `stride` rows."""
    return np.array([*{row // stride: row for row in rows.tolist()}.values()], dtype=np.int64)


def _drawing(each: Carried, rows: Int, pose: Float, colors: tuple[str, ...]) -> Drawing:
    color = colors[each.robot]
    if len(rows) and not _rigid(each, rows, color):
        pairs = zip(pose[rows, :, each.robot], each.readings[rows], strict=True)
        return Drawing(rows.tolist(), [_drawn(each, *pair, color) for pair in pairs])
    known: dict[bytes, Flat] = {}
    scenes: list[Flat] = []
    for row in rows.tolist():
        reading = each.readings[row]
        key = reading.tobytes()
        if key not in known:
            known[key] = _drawn(each, np.zeros(3), reading, color)
        scenes.append(known[key])
    return Drawing(rows.tolist(), scenes, each.robot, each.sensor.stays)


def _drawn(each: Carried, pose: Float, reading: Any, color: str) -> Flat:
    scene = Scene()
    with called(f"sensor {each.name!r}", each.sensor.draw):
        each.sensor.draw(scene, pose, reading, color)
    return flat(scene.shapes)


def _rigid(each: Carried, rows: Int, color: str) -> bool:
    """Return whether what it draws moves with the robot."""
    for row in rows[[0, len(rows) // 2, -1]].tolist():
        reading = each.readings[row]
        here = _drawn(each, np.zeros(3), reading, color)
        there = _drawn(each, ELSEWHERE, reading, color)
        if here.styles != there.styles or here.counts != there.counts:
            return False
        if not np.allclose(moved(here, ELSEWHERE), there.numbers, atol=1e-9, equal_nan=True):
            return False
    return True


def pack_readings(sensors: list[Carried], every: int) -> tuple[Columns, list[dict[str, Any]]]:
    """Return the readings of few numbers as columns, and how they are to be said in words."""
    columns = Columns()
    found: list[dict[str, Any]] = []
    for each in sensors:
        values = each.readings[::every].reshape(len(each.readings[::every]), -1).astype(float)
        if not 0 < values.shape[1] <= WORDS:
            continue
        finite = values[np.isfinite(values)]
        step = max(float(np.abs(finite).max(initial=0.0)), 1e-6) / 2**15
        name = f"reading{len(found)}"
        columns.add(name, rounded(values, step), order=1, step=step, every=every)
        found.append({
            "name": each.name,
            "robot": each.robot,
            "column": name,
            "parts": [_part(q) for q in _quantities(each.sensor, values.shape[1])],
        })  # fmt: skip
    return columns, found


def _quantities(sensor: Sensor, count: int) -> list[Quantity]:
    """Return what each number of a reading is."""
    stated = list(sensor.quantities) or [Quantity("value")]
    if count % len(stated) == 0 and len(stated) > 1:
        return stated * (count // len(stated))
    first = stated[0]
    if count == 1:
        return [first]
    return [Quantity(f"{first.name} {k}", first.unit, first.kind) for k in range(count)]


def _part(quantity: Quantity) -> list[str]:
    return [quantity.name, quantity.unit, quantity.kind]
