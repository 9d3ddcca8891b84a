"""The messages in which Foxglove shows a run: poses, frames, scans, and the scene.

Imported when a log is written: it needs foxglove-sdk.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import atan2, cos, hypot, sin
from typing import Any, NamedTuple

import numpy as np
from foxglove import messages
from numpy.typing import NDArray

from mars2d.bodies.colors import prop_colors
from mars2d.core.scene import Circle, Line, Polygon, Scene, rgb
from mars2d.output.formats.mcap.row import Row, nanoseconds
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


class _Scan(NamedTuple):
    """A sensor on a robot whose readings are laser scans, and the message that is sent for each."""

    topic: str
    key: str
    place: int  # of its robot among those that carry it
    period: int  # control steps
    age: int  # control steps
    said: Mapping[str, Any]  # what is the same in all of its messages


class Topics:
    """Makes Foxglove's messages from the rows of one run.

    ``/poses``: the poses of all robots and props, in the world. ``/tf``: the same as frames.
    ``/scene``: the ground and the looks of the bodies, each in its frame. ``/ROBOT/SENSOR``: laser
    scans, when they arrive, in the robot's frame. ``/contacts``: an arrow for each contact of the
    control step that begins then, along the mean force on the second body, 1 m long for 100 N.
    """

    def __init__(self, scenario: Scenario, sensor_robots: Mapping[str, tuple[int, ...]]) -> None:
        """Take a scenario, and the robots that carry each sensor that is recorded."""
        self._dt = scenario.sampling_time
        self._names = [str(body.name) for body in scenario.bodies]
        self._world = "world"
        while self._world in self._names:
            self._world += "_"
        self._scans = [
            scan
            for key, robots in sensor_robots.items()
            for place, robot in enumerate(robots)
            if (scan := self._scan(scenario, key, place, robot)) is not None
        ]
        self._touched = False
        self._drawn: Scenario | None = None

    def _scan(self, scenario: Scenario, key: str, place: int, robot: int) -> _Scan | None:
        """Return what is known of a sensor whose readings are laser scans; None of others."""
        sensor, name = scenario.robots[robot].sensor(key), self._names[robot]
        if sensor is None or sensor.fan is None or sensor.fan.cone:
            return None
        start, end = sensor.fan.angles[[0, -1]].tolist()
        pose = _pose(*sensor.placed(np.zeros(3)).tolist())
        said = {"frame_id": name, "pose": pose, "start_angle": start, "end_angle": end}
        period, age = sensor.period(self._dt), sensor.age(self._dt)
        return _Scan(f"/{name}/{key}", key, place, period, age, said)

    def draw_again(self) -> None:
        """Send the scene with the next row once more."""
        self._drawn = None

    def messages(self, row: Row, scenario: Scenario) -> Iterator[tuple[str, Any]]:
        """Yield the topic of each message of a row, and the message.

        scenario: as it is at that row.
        """
        now = _timestamp(row.time)
        if scenario is not self._drawn:
            self._drawn = scenario
            yield "/scene", self._scene(scenario, now)
        numbers = np.hstack([row.columns[name].reshape(3, -1) for name in ("pose", "prop_pose")])
        places = [
            (messages.Vector3(x=x, y=y, z=0.0), _turn(theta)) for x, y, theta in numbers.T.tolist()
        ]
        poses = [messages.Pose(position=at, orientation=turn) for at, turn in places]
        yield "/poses", messages.PosesInFrame(timestamp=now, frame_id=self._world, poses=poses)
        links = [
            messages.FrameTransform(
                timestamp=now,
                parent_frame_id=self._world,
                child_frame_id=name,
                translation=at,
                rotation=turn,
            )
            for name, (at, turn) in zip(self._names, places, strict=True)
        ]
        yield "/tf", messages.FrameTransforms(transforms=links)
        if len(row.contacts) or self._touched:
            self._touched = len(row.contacts) > 0
            yield "/contacts", self._contacts(row.contacts, now)
        for topic, key, place, period, age, said in self._scans:
            measured = row.row - age
            if measured >= 0 and measured % period == 0:
                ranges = row.columns[f"sensor:{key}"][place].tolist()
                then = _timestamp(measured * self._dt)
                yield topic, messages.LaserScan(timestamp=then, ranges=ranges, **said)

    def _contacts(self, contacts: NDArray[np.void], now: Any) -> Any:
        """Return arrows for contacts, which replace those of earlier messages."""
        shaft, length, head = ARROW
        arrows = [
            messages.ArrowPrimitive(
                pose=_pose(x, y, atan2(up, across), ARROW_HEIGHT),
                shaft_length=METRES_PER_NEWTON * hypot(across, up),
                shaft_diameter=shaft,
                head_length=length,
                head_diameter=head,
                color=_color(ARROW_COLOR),
            )
            for (x, y), (across, up) in zip(
                contacts["point"].tolist(), mean_forces(contacts, self._dt).tolist(), strict=True
            )
        ]
        entity = messages.SceneEntity(
            id="contacts", frame_id=self._world, timestamp=now, arrows=arrows
        )
        return messages.SceneUpdate(entities=[entity])

    def _scene(self, scenario: Scenario, now: Any) -> Any:
        """Return all that is drawn; it replaces the entities of earlier messages."""
        ground = Scene([*workspace(scenario).shapes, *obstacles(scenario).shapes])
        scenes = [("ground", self._world, ground, GROUND_HEIGHT)]
        start, names = np.zeros(3), iter(self._names)
        for robot, color in zip(scenario.robots, scenario.colors, strict=True):
            drawn, name = Scene(), next(names)
            draw_robot(drawn, robot, start, color, prop_edge(color))
            scenes.append((f"body {name}", name, drawn, 0.0))
        for prop, color in zip(scenario.props, prop_colors(scenario.props), strict=True):
            drawn, name = Scene(), next(names)
            draw_prop(drawn, prop, start, color)
            scenes.append((f"body {name}", name, drawn, 0.0))
        entities = [
            messages.SceneEntity(
                id=name, frame_id=within, frame_locked=True, timestamp=now, **_drawn(scene, floor)
            )
            for name, within, scene, floor in scenes
        ]
        return messages.SceneUpdate(entities=entities)


# -- shapes as parts of an entity -------------------------------------------------------------


def _drawn(scene: Scene, floor: float) -> dict[str, Any]:
    """Return a scene's discs, outlines and lines as the primitives of an entity, by their kind.

    floor: the height of the first shape, metres.
    """
    found: dict[str, Any] = {"cylinders": [], "lines": []}
    for k, shape in enumerate(scene.shapes):
        z, outline = floor + k * SHAPE_HEIGHT, np.empty((0, 2))
        if isinstance(shape, Circle):
            angle = np.linspace(0.0, 2 * np.pi, RING_CORNERS, endpoint=False)
            outline = shape.center + shape.radius * np.column_stack([np.cos(angle), np.sin(angle)])
            if shape.fill is not None:
                across = 2 * shape.radius
                found["cylinders"].append(
                    messages.CylinderPrimitive(
                        pose=_pose(*shape.center, 0.0, z),
                        size=messages.Vector3(x=across, y=across, z=SHAPE_HEIGHT),
                        bottom_scale=1.0,
                        top_scale=1.0,
                        color=_color(shape.fill),
                    )
                )
        elif isinstance(shape, Polygon | Line):
            outline = shape.points
        if len(outline) and isinstance(shape, Circle | Polygon | Line) and shape.stroke:
            kind = messages.LinePrimitiveLineType
            found["lines"].append(
                messages.LinePrimitive(
                    type=kind.LineStrip if isinstance(shape, Line) else kind.LineLoop,
                    pose=_pose(0.0, 0.0, 0.0),
                    thickness=shape.width,
                    scale_invariant=True,
                    points=_points(outline, z),
                    color=_color(shape.stroke),
                )
            )
    return found


def _timestamp(time: float) -> Any:
    return messages.Timestamp(*divmod(nanoseconds(time), 10**9))


def _pose(x: float, y: float, theta: float, z: float = 0.0) -> Any:
    return messages.Pose(position=messages.Vector3(x=x, y=y, z=z), orientation=_turn(theta))


def _turn(theta: float) -> Any:
    return messages.Quaternion(x=0.0, y=0.0, z=sin(theta / 2), w=cos(theta / 2))


def _points(points: Float, z: float) -> list[Any]:
    return [messages.Point3(x=x, y=y, z=z) for x, y in points.tolist()]


def _color(color: str) -> Any:
    red, green, blue = rgb(color[:7])
    opacity = int(color[7:9], 16) / 255 if len(color) > 7 else 1.0
    return messages.Color(r=red, g=green, b=blue, a=opacity)
