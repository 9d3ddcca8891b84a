"""What Foxglove shows of a run: its own messages, made of the rows."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import cos, sin
from typing import Any, NamedTuple

import numpy as np

from mars2d.core.scene import Scene
from mars2d.output.formats.mcap.drawing import draw
from mars2d.output.formats.mcap.row import Row
from mars2d.output.formats.mcap.wire import block, packed, varint
from mars2d.output.layers.bodies import draw_prop, draw_robot, prop_colors, prop_edge
from mars2d.output.layers.ground import obstacles, workspace
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.range_finder import RangeFinder

__all__ = ["Topics", "nanoseconds"]

BENEATH = -0.1
"""The height at which the workspace and the obstacles lie, metres: below the bodies."""

RANGES = 6
"""The number of the field of a LaserScan that holds the ranges."""


def nanoseconds(time: float) -> int:
    """Return a simulated time [s] as MCAP has it."""
    return round(float(time) * 1e9)  # numpy's own numbers are rounded slowly


class _Scan(NamedTuple):
    """One range finder: where its readings are found, and what all its messages have."""

    channel: int
    key: str
    place: int  # of its robot among those that carry it
    period: int  # control steps
    age: int  # control steps
    head: bytes


class Topics:
    """Makes Foxglove's messages of the rows of one run.

    ``/poses`` poses of all robots and props, in the world. ``/tf`` the same as frames.
    ``/scene`` what stands there, and how bodies look, each in its frame. ``/ROBOT/SENSOR`` the
    scans of range finders, when they arrive, in the robot's frame.
    """

    def __init__(
        self,
        scenario: Scenario,
        sensor_robots: Mapping[str, tuple[int, ...]],
        channel: Callable[[str, Any], int],
    ) -> None:
        """Take what is simulated.

        sensor_robots: which robots carry each sensor that is recorded. channel: returns the number
        of the channel for a topic and a class of messages.
        """
        from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
        from foxglove_schemas_protobuf.PosesInFrame_pb2 import PosesInFrame
        from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

        self._dt = scenario.sampling_time
        self._names = [str(body.name) for body in scenario.bodies]
        self._world = "world"
        while self._world in self._names:
            self._world += "_"
        self._scene_channel = channel("/scene", SceneUpdate)
        self._poses_channel, self._poses = channel("/poses", PosesInFrame), PosesInFrame()
        self._tf_channel, self._tf = channel("/tf", FrameTransforms), FrameTransforms()
        self._poses.frame_id = self._world
        self._places = []
        for name in self._names:
            pose = self._poses.poses.add()
            link = self._tf.transforms.add(parent_frame_id=self._world, child_frame_id=name)
            pose.position.z = link.translation.z = 0.0
            self._places.append(
                (
                    pose.position,
                    pose.orientation,
                    link.timestamp,
                    link.translation,
                    link.rotation,
                )
            )
        self._scans = [
            self._scan(scenario, key, robots.index(i), i, channel)
            for key, robots in sensor_robots.items()
            for i in robots
            if isinstance(scenario.robots[i].sensor(key), RangeFinder)
        ]
        self._drawn: Scenario | None = None

    def _scan(
        self,
        scenario: Scenario,
        key: str,
        place: int,
        robot: int,
        channel: Callable[[str, Any], int],
    ) -> _Scan:
        from foxglove_schemas_protobuf.LaserScan_pb2 import LaserScan

        sensor: Any = scenario.robots[robot].sensor(key)
        x, y, theta = sensor.placed(np.zeros(3)).tolist()
        scan = LaserScan(frame_id=self._names[robot])
        scan.pose.position.x, scan.pose.position.y = x, y
        scan.pose.orientation.z, scan.pose.orientation.w = np.sin(theta / 2), np.cos(theta / 2)
        scan.start_angle, scan.end_angle = sensor.angles[[0, -1]].tolist()
        return _Scan(
            channel(f"/{self._names[robot]}/{key}", LaserScan),
            key,
            place,
            sensor.period(self._dt),
            sensor.age(self._dt),
            scan.SerializeToString(),
        )

    def messages(self, row: Row, scenario: Scenario) -> Iterator[tuple[int, bytes]]:
        """Yield the messages of a row, and of each the channel. scenario: as it is by then."""
        ns = nanoseconds(row.time)
        if scenario is not self._drawn:
            self._drawn = scenario
            yield self._scene_channel, self._scene(scenario, ns)
        seconds, nanos = divmod(ns, 10**9)
        self._poses.timestamp.seconds, self._poses.timestamp.nanos = seconds, nanos
        poses = [row.pose.tolist(), row.prop_pose.tolist()]
        places = iter(self._places)
        for xs, ys, thetas in poses:
            for x, y, theta in zip(xs, ys, thetas, strict=True):
                position, orientation, stamp, translation, rotation = next(places)
                position.x = translation.x = x
                position.y = translation.y = y
                orientation.z = rotation.z = sin(theta / 2)
                orientation.w = rotation.w = cos(theta / 2)
                stamp.seconds, stamp.nanos = seconds, nanos
        yield self._poses_channel, self._poses.SerializeToString()
        yield self._tf_channel, self._tf.SerializeToString()
        for channel, key, place, period, age, head in self._scans:
            measured = row.row - age
            if measured >= 0 and measured % period == 0:
                stamp = _stamp(nanoseconds(measured * self._dt))
                yield channel, stamp + head + packed(RANGES, row.readings[key][place])

    def _scene(self, scenario: Scenario, ns: int) -> bytes:
        """Return all that is drawn: what is there already is replaced by it."""
        from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

        update = SceneUpdate()

        def add(name: str, within: str, scene: Scene, floor: float) -> None:
            entity = update.entities.add(id=name, frame_id=within, frame_locked=True)
            entity.timestamp.FromNanoseconds(ns)
            draw(entity, scene, floor)

        grounds = Scene([*workspace(scenario).shapes, *obstacles(scenario).shapes])
        add("ground", self._world, grounds, BENEATH)
        start = np.zeros(3)
        names = iter(self._names)
        for robot, color in zip(scenario.robots, scenario.colors, strict=True):
            drawn, name = Scene(), next(names)
            draw_robot(drawn, robot, start, color, prop_edge(color))
            add(f"body {name}", name, drawn, 0.0)
        for prop, color in zip(scenario.props, prop_colors(scenario.props), strict=True):
            drawn, name = Scene(), next(names)
            draw_prop(drawn, prop, start, color)
            add(f"body {name}", name, drawn, 0.0)
        return bytes(update.SerializeToString())


def _stamp(ns: int) -> bytes:
    """Return the field `timestamp`, the first of a message."""
    seconds, nanos = divmod(ns, 10**9)
    return block(1, b"\x08" + varint(seconds) + b"\x10" + varint(nanos))
