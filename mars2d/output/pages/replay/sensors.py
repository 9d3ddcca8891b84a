"""What a record's sensors draw of their readings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.output.pages.replay.columns import Int
from mars2d.output.pages.replay.drawings import Drawing, Flat, Float, flat, follows
from mars2d.sensors.base import Sensor

if TYPE_CHECKING:
    from mars2d.record.rows import Rows

FEW_SCENES = 8
"""The most scenes of a sensor that is never thinned."""

MAX_DRAWN = 10_000
"""The most readings that are drawn."""

ELSEWHERE = np.array([0.7, -0.4, 1.1])
"""A pose that tells drawings in a robot's frame from drawings in that of the world."""


class Carried:
    """A sensor on a robot, and its readings at the rows of a replay, (R, ...).

    pose: (R, 3), of the robot where each was measured. lags: whether some were so at earlier rows.
    """

    def __init__(self, record: Rows, kept: Int, name: str, k: int, sensor: Sensor) -> None:
        """Take the k-th robot that has a sensor; kept: the rows of the replay, (R,)."""
        self.name, self.robot, self.sensor = name, record.sensor_robots[name][k], sensor
        self.readings = record.sensors[name][kept, k]
        dt = record.scenario.sampling_time
        measured = [sensor.measured_at(row, dt) for row in kept.tolist()]
        self.pose: Float = record.pose[measured, :, self.robot]
        self.lags = sensor.period(dt) > 1 or sensor.age(dt) > 0

    def changes(self) -> Int:
        """Return the rows at which its reading changes, or from where it is drawn if it lags."""
        if not len(self.readings):
            return np.empty(0, dtype=np.int64)
        bits = np.ascontiguousarray(self.readings).view(np.uint8).reshape(len(self.readings), -1)
        changed = np.any(bits[1:] != bits[:-1], axis=1)
        if self.lags:
            changed |= np.any(np.diff(self.pose, axis=0) != 0, axis=1)
        return np.concatenate([[0], np.flatnonzero(changed) + 1])


def carried(record: Rows, kept: Int) -> Iterator[Carried]:
    """Yield the sensors of a record; a loaded record lacks those of the user's own."""
    for name, robots in record.sensor_robots.items():
        for k, robot in enumerate(robots):
            sensor = record.scenario.robots[robot].sensor(name)
            if sensor is not None:
                yield Carried(record, kept, name, k, sensor)


def drawings(sensors: list[Carried], colors: tuple[str, ...]) -> tuple[list[Drawing], int]:
    """Return the drawings of readings, one for each `stride` rows, and the stride."""
    changes = [each.changes() for each in sensors]
    stride, many = 1, [rows for rows in changes if len(rows) > FEW_SCENES]
    while sum(len(np.unique(rows // stride)) for rows in many) > MAX_DRAWN:
        stride *= 2
    found = [
        _drawing(each, rows if len(rows) <= FEW_SCENES else _last(rows, stride), colors)
        for each, rows in zip(sensors, changes, strict=True)
    ]
    return found, stride


def _last(rows: Int, stride: int) -> Int:
    """Return the first row, and the last of each `stride` rows."""
    last = {row // stride: row for row in rows.tolist()}
    return np.array(sorted({int(rows[0]), *last.values()}), dtype=np.int64)


def _drawing(each: Carried, rows: Int, colors: tuple[str, ...]) -> Drawing:
    color = colors[each.robot]
    if len(rows) and (each.lags or not _rigid(each, rows, color)):
        pairs = zip(each.pose[rows], each.readings[rows], strict=True)
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
    """Return whether its drawings move with the robot."""
    for row in rows[[0, len(rows) // 2, -1]].tolist():
        reading = each.readings[row]
        here = _drawn(each, np.zeros(3), reading, color)
        there = _drawn(each, ELSEWHERE, reading, color)
        if not follows(here, there, ELSEWHERE):
            return False
    return True
