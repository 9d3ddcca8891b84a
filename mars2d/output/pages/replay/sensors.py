"""The readings of a record's sensors, as columns of a replay."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.output.pages.replay.columns import Columns, Int
from mars2d.output.pages.replay.drawings import Drawing, Flat, Float, flat, follows
from mars2d.sensors.base import Fan, Sensor

if TYPE_CHECKING:
    from mars2d.record.rows import Rows

FEW_SCENES = 8
"""The most scenes of a sensor that is never thinned."""

MAX_BEAMS = 360
"""The most beams of a sensor that are drawn."""

MAX_DRAWN = 5000
"""The most readings that are drawn."""

LEVELS = 254
"""The levels to which distances are rounded; one more level means that nothing is there."""

ELSEWHERE = np.array([0.7, -0.4, 1.1])
"""A pose that tells drawings in a robot's frame from drawings in that of the world."""


class Carried:
    """A sensor on a robot, and its readings at the rows of a replay, (R, ...)."""

    def __init__(self, name: str, robot: int, sensor: Sensor, readings: NDArray[Any]) -> None:
        """Keep them together."""
        self.name, self.robot, self.sensor, self.readings = name, robot, sensor, readings

    @property
    def beams(self) -> Fan:
        """The beams of a sensor that has some."""
        fan = self.sensor.fan
        assert fan is not None
        return fan

    @property
    def is_fan(self) -> bool:
        """Whether its readings are distances along beams, and drawn as such."""
        fan, kind = self.sensor.fan, type(self.sensor)
        if fan is None or _definer(kind, "draw") is not _definer(kind, "fan"):
            return False  # a class of the user's may draw something else
        return self.readings.shape[1:] == np.shape(fan.angles) and self.readings.dtype.kind == "f"

    def changes(self) -> Int:
        """Return the rows at which its reading changes."""
        if not len(self.readings):
            return np.empty(0, dtype=np.int64)
        bits = np.ascontiguousarray(self.readings).view(np.uint8).reshape(len(self.readings), -1)
        changed = np.any(bits[1:] != bits[:-1], axis=1)
        return np.concatenate([[0], np.flatnonzero(changed) + 1])


def carried(record: Rows, kept: Int) -> Iterator[Carried]:
    """Yield the sensors of a record; a loaded record lacks those of the user's own."""
    for name, robots in record.sensor_robots.items():
        for k, robot in enumerate(robots):
            sensor = record.scenario.robots[robot].sensor(name)
            if sensor is not None:
                yield Carried(name, robot, sensor, record.sensors[name][kept, k])


def fans_of(fans: list[Carried], colors: tuple[str, ...]) -> list[dict[str, Any]]:
    """Return the beams of sensors, and the styles in which `draw` draws their area and hits."""
    found = []
    for each in fans:
        fan = each.beams
        skip = _skip(len(fan.angles))
        sample = _drawn(
            each, np.zeros(3), np.full(len(fan.angles), fan.range / 2), colors[each.robot]
        )
        area, hits = sample.styles[:2]
        found.append({
            "name": each.name,
            "robot": each.robot,
            "range": fan.range,
            "mount": list(each.sensor.mount),
            "first": float(fan.angles[0]),
            "apart": float(fan.angles[1] - fan.angles[0]) * skip if len(fan.angles) > 1 else 0.0,
            "beams": len(fan.angles[::skip]),
            "cone": fan.cone,
            "closed": fan.closed,
            "styles": [list(area), list(hits)],
        })  # fmt: skip
    return found


def pack_fans(fans: list[Carried], every: int) -> tuple[Columns, int]:
    """Return the distances of all fans at one row in `every`, a byte each."""
    columns = Columns()
    rows = np.arange(0, len(fans[0].readings), every)
    levels = []
    for each in fans:
        far = each.readings[rows][:, :: _skip(each.readings.shape[1])]
        share = far / each.beams.range
        near = np.isfinite(far)
        level = np.rint(LEVELS * np.clip(np.where(near, share, 0.0), 0, 1)).astype(np.uint8)
        levels.append(np.where(near, level, LEVELS + 1).astype(np.uint8))
    columns.add_bytes("fans", np.concatenate(levels, axis=1), every=every)
    return columns, len(rows)


def beams_left_out(fans: list[Carried]) -> list[str]:
    """Return for each kind of scanner of too many beams, in words, how many of them are drawn."""
    skips = {each.name: _skip(each.readings.shape[1]) for each in fans}
    return [f"beams of {name}: one in {skip}" for name, skip in skips.items() if skip > 1]


def _definer(kind: type, name: str) -> type | None:
    """Return the class in which an attribute of a class is defined."""
    return next((each for each in kind.__mro__ if name in vars(each)), None)


def _skip(beams: int) -> int:
    return -(-beams // MAX_BEAMS)


def drawings(
    sensors: list[Carried], pose: Float, colors: tuple[str, ...]
) -> tuple[list[Drawing], int]:
    """Return the sensors' drawings of their readings, one for each `stride` rows, and the stride.

    pose: (R, 3, n), of the rows of a replay.
    """
    changes = [each.changes() for each in sensors]
    stride = 1
    while (
        sum(len(np.unique(rows // stride)) for rows in changes if len(rows) > FEW_SCENES)
        > MAX_DRAWN
    ):
        stride *= 2
    found = [
        _drawing(each, rows if len(rows) <= FEW_SCENES else _last(rows, stride), pose, colors)
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
    """Return whether its drawings move with the robot."""
    for row in rows[[0, len(rows) // 2, -1]].tolist():
        reading = each.readings[row]
        here = _drawn(each, np.zeros(3), reading, color)
        there = _drawn(each, ELSEWHERE, reading, color)
        if not follows(here, there, ELSEWHERE):
            return False
    return True
