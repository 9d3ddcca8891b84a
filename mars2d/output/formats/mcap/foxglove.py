"""The messages in which Foxglove shows a run: poses, frames, scans, and the scene."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from math import atan2, cos, hypot, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.colors import prop_colors
from mars2d.core.scene import Circle, Line, Polygon, Scene, rgb
from mars2d.output.formats.mcap.row import Row, with_arrays_as_bytes
from mars2d.output.layers.bodies import draw_prop, draw_robot, prop_edge
from mars2d.output.layers.ground import obstacles, workspace
from mars2d.record.contact import mean_forces
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

GROUND_HEIGHT = -0.1
"""The height of the workspace and the obstacles, metres: below the bodies."""

SHAPE_HEIGHT = 1e-3
"""How far a shape lies above the one before it, metres."""

RING_CORNERS = 48

METRES_PER_NEWTON, ARROW_HEIGHT, ARROW_COLOR = 0.01, 0.1, "#a50038"
ARROW = 0.02, 0.08, 0.06
"""Of a contact's arrow: the diameter of its shaft, length and diameter of its head, metres."""


def nanoseconds(time: float) -> int:
    """Return a simulated time [s] in nanoseconds, as MCAP counts."""
    return round(float(time) * 1e9)  # rounding numbers of numpy is slow


def schema_of(kind: Any) -> bytes:
    """Return the schema of a class of messages, a FileDescriptorSet with all that it imports."""
    from google.protobuf.descriptor_pb2 import FileDescriptorSet

    found: dict[str, Any] = {}

    def add(file: Any) -> None:
        if file.name not in found:
            for needed in file.dependencies:
                add(needed)
            found[file.name] = file

    add(kind.DESCRIPTOR.file)
    files = FileDescriptorSet()
    for file in found.values():
        file.CopyToProto(files.file.add())
    return bytes(files.SerializeToString())


class _Scan(NamedTuple):
    """A sensor on a robot whose readings are laser scans, and the message that is sent for each."""

    channel: Any
    key: str
    place: int  # of its robot among those that carry it
    period: int  # control steps
    age: int  # control steps
    message: Any


class Topics:
    """Makes Foxglove's messages from the rows of one run.

    ``/poses``: the poses of all robots and props, in the world. ``/tf``: the same as frames.
    ``/scene``: the ground and the looks of the bodies, each in its frame. ``/ROBOT/SENSOR``: laser
    scans, when they arrive, in the robot's frame. ``/contacts``: an arrow for each contact of the
    control step that begins then, along the mean force on the second body, 1 m long for 100 N.
    """

    def __init__(
        self,
        scenario: Scenario,
        sensor_robots: Mapping[str, tuple[int, ...]],
        channel: Callable[[str, Any], Any],
    ) -> None:
        """Open the channels for a scenario.

        sensor_robots: the robots that carry each sensor that is recorded. channel: returns the
        channel for a topic and a class of messages.
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
            self._places.append((pose, link))
        self._contacts_channel, self._touched = channel("/contacts", SceneUpdate), False
        self._scans = list(self._scanned(scenario, sensor_robots, channel))
        self._drawn: Scenario | None = None

    def _scanned(
        self,
        scenario: Scenario,
        sensor_robots: Mapping[str, tuple[int, ...]],
        channel: Callable[[str, Any], Any],
    ) -> Iterator[_Scan]:
        """Yield the sensors whose readings are laser scans."""
        from foxglove_schemas_protobuf.LaserScan_pb2 import LaserScan

        message_class: Any = None
        for key, robots in sensor_robots.items():
            for place, robot in enumerate(robots):
                sensor = scenario.robots[robot].sensor(key)
                fan = None if sensor is None else sensor.fan
                if sensor is None or fan is None or fan.cone:
                    continue
                message_class = message_class or with_arrays_as_bytes(
                    schema_of(LaserScan), LaserScan.DESCRIPTOR.full_name
                )
                x, y, theta = sensor.placed(np.zeros(3)).tolist()
                scan = message_class(frame_id=self._names[robot])
                scan.pose.position.x, scan.pose.position.y = x, y
                scan.pose.orientation.z, scan.pose.orientation.w = sin(theta / 2), cos(theta / 2)
                scan.start_angle, scan.end_angle = fan.angles[[0, -1]].tolist()
                yield _Scan(
                    channel(f"/{self._names[robot]}/{key}", LaserScan),
                    key,
                    place,
                    sensor.period(self._dt),
                    sensor.age(self._dt),
                    scan,
                )

    def draw_again(self) -> None:
        """Send the scene with the next row once more."""
        self._drawn = None

    def messages(self, row: Row, scenario: Scenario) -> Iterator[tuple[Any, bytes]]:
        """Yield the channel and the bytes of each message of a row.

        scenario: as it is at that row.
        """
        ns = nanoseconds(row.time)
        if scenario is not self._drawn:
            self._drawn = scenario
            yield self._scene_channel, self._scene(scenario, ns)
        seconds, nanos = divmod(ns, 10**9)
        self._poses.timestamp.seconds, self._poses.timestamp.nanos = seconds, nanos
        poses = np.hstack([row.columns["pose"], row.columns["prop_pose"]]).T.tolist()
        for (pose, link), (x, y, theta) in zip(self._places, poses, strict=True):
            pose.position.x = link.translation.x = x
            pose.position.y = link.translation.y = y
            pose.orientation.z = link.rotation.z = sin(theta / 2)
            pose.orientation.w = link.rotation.w = cos(theta / 2)
            link.timestamp.seconds, link.timestamp.nanos = seconds, nanos
        yield self._poses_channel, self._poses.SerializeToString()
        yield self._tf_channel, self._tf.SerializeToString()
        if len(row.contacts) or self._touched:
            self._touched = len(row.contacts) > 0
            yield self._contacts_channel, self._contacts(row.contacts, seconds, nanos)
        for channel, key, place, period, age, scan in self._scans:
            measured = row.row - age
            if measured >= 0 and measured % period == 0:
                seconds, nanos = divmod(nanoseconds(measured * self._dt), 10**9)
                scan.timestamp.seconds, scan.timestamp.nanos = seconds, nanos
                scan.ranges = (
                    row.columns[f"sensor:{key}"][place].astype("<f8", copy=False).tobytes()
                )
                yield channel, scan.SerializeToString()

    def _contacts(self, contacts: NDArray[np.void], seconds: int, nanos: int) -> bytes:
        """Return arrows for contacts, which replace those of earlier messages."""
        from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

        update = SceneUpdate()
        entity = update.entities.add(id="contacts", frame_id=self._world)
        entity.timestamp.seconds, entity.timestamp.nanos = seconds, nanos
        forces = mean_forces(contacts, self._dt)
        for (x, y), (across, up) in zip(contacts["point"].tolist(), forces.tolist(), strict=True):
            arrow, way = entity.arrows.add(), atan2(up, across)
            _put(arrow.pose.position, x, y, ARROW_HEIGHT)
            arrow.pose.orientation.z, arrow.pose.orientation.w = sin(way / 2), cos(way / 2)
            arrow.shaft_length = METRES_PER_NEWTON * hypot(across, up)
            arrow.shaft_diameter, arrow.head_length, arrow.head_diameter = ARROW
            _color(arrow.color, ARROW_COLOR)
        return bytes(update.SerializeToString())

    def _scene(self, scenario: Scenario, ns: int) -> bytes:
        """Return all that is drawn; it replaces the entities of earlier messages."""
        from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

        update = SceneUpdate()

        def add(name: str, within: str, scene: Scene, floor: float) -> None:
            entity = update.entities.add(id=name, frame_id=within, frame_locked=True)
            entity.timestamp.FromNanoseconds(ns)
            _draw(entity, scene, floor)

        grounds = Scene([*workspace(scenario).shapes, *obstacles(scenario).shapes])
        add("ground", self._world, grounds, GROUND_HEIGHT)
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


# -- shapes as entities of a scene ------------------------------------------------------------


def _draw(entity: Any, scene: Scene, floor: float) -> None:
    """Add a scene's discs, outlines and lines to a ``foxglove.SceneEntity``, in its frame.

    floor: the height of the first shape, metres.
    """
    for k, shape in enumerate(scene.shapes):
        z = floor + k * SHAPE_HEIGHT
        if isinstance(shape, Circle):
            if shape.fill is not None:
                _disc(entity, shape, z)
            if shape.stroke is not None:
                angle = np.linspace(0.0, 2 * np.pi, RING_CORNERS, endpoint=False)
                ring = shape.radius * np.column_stack([np.cos(angle), np.sin(angle)])
                _line(entity, shape.center + ring, shape.stroke, shape.width, z, closed=True)
        elif isinstance(shape, Polygon):
            if shape.fill is not None:
                _area(entity, shape.points, shape.fill, z)
            if shape.stroke is not None:
                _line(entity, shape.points, shape.stroke, shape.width, z, closed=True)
        elif isinstance(shape, Line):
            _line(entity, shape.points, shape.stroke, shape.width, z, closed=False)


def _disc(entity: Any, circle: Circle, z: float) -> None:
    disc = entity.cylinders.add(bottom_scale=1.0, top_scale=1.0)
    _put(disc.pose.position, *circle.center, z)
    disc.pose.orientation.w = 1.0
    _put(disc.size, 2 * circle.radius, 2 * circle.radius, SHAPE_HEIGHT)
    _color(disc.color, circle.fill or "")


def _area(entity: Any, points: Float, fill: str, z: float) -> None:
    import shapely

    area = shapely.make_valid(shapely.Polygon(points))
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(area))
    if not len(triangles):
        return
    drawn = entity.triangles.add()
    drawn.pose.orientation.w = 1.0
    _color(drawn.color, fill)
    for triangle in triangles:
        _points(drawn, list(triangle.exterior.coords)[:3], z)


def _line(entity: Any, points: Float, stroke: str, width: float, z: float, *, closed: bool) -> None:
    line = entity.lines.add(thickness=width, scale_invariant=True)
    line.type = line.LINE_LOOP if closed else line.LINE_STRIP
    line.pose.orientation.w = 1.0
    _color(line.color, stroke)
    _points(line, points, z)


def _points(primitive: Any, points: Iterable[Iterable[float]], z: float) -> None:
    for x, y in points:
        _put(primitive.points.add(), float(x), float(y), z)


def _put(vector: Any, x: float, y: float, z: float) -> None:
    vector.x, vector.y, vector.z = x, y, z


def _color(target: Any, color: str) -> None:
    target.r, target.g, target.b = rgb(color[:7])
    target.a = int(color[7:9], 16) / 255 if len(color) > 7 else 1.0
