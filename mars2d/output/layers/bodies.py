"""The looks of single bodies: robots, props, and the joints between them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.bodies.colors import prop_color, prop_colors
from mars2d.bodies.joints.base import AttachedJoint
from mars2d.bodies.props.base import Prop
from mars2d.core.plane import Point
from mars2d.core.scene import INK, Scene, Text, faded
from mars2d.core.usercode import called
from mars2d.geometry.shapes import Disc, Rim, Shape
from mars2d.record.frame import Frame
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]


def draw_robot(scene: Scene, robot: Robot, pose: Float, fill: str | None, stroke: str) -> None:
    """Draw a robot to scale, at a pose (3,): its chassis, and a line ahead that shows its heading.

    The line goes from the centre of rotation to the front; a robot that turns about another point
    than its geometric centre has a dot there. fill: None draws it hollow.
    """
    x, y, theta = pose.tolist()
    offset = robot.center_offset
    mark = stroke if fill is None else "#ffffff"
    if robot.shape is None:
        c, s = cos(theta), sin(theta)
        center, r = (x - offset * c, y - offset * s), robot.radius
        scene.circle(center, r, fill=fill, stroke=stroke, width=1.5)
        ends = [(center[0] + d * c, center[1] + d * s) for d in (min(offset, 0.0), r)]
        scene.line(ends, stroke=mark, width=2.5)
    else:
        chassis = robot.chassis
        _draw_shape(scene, chassis, pose, fill, stroke, 1.5)
        r = chassis.thickness / 2
        scene.line(_placed(_ahead(chassis), pose), stroke=mark, width=2.5)
    if offset:
        scene.circle((x, y), r / 6, fill=mark)  # the centre of rotation


def draw_prop(scene: Scene, prop: Prop, pose: Float, color: str, *, hollow: bool = False) -> None:
    """Draw a prop at a pose (3,); a faint line from its centre of mass ahead shows how it turns."""
    edge = prop_edge(color)
    stroke = faded(edge, 0.7) if hollow else edge
    _draw_shape(scene, prop.shape, pose, None if hollow else color, stroke, 1.5)
    scene.line(_placed(_ahead(prop.shape), pose), stroke=faded(edge, 0.45), width=1.5)


def place_robot(scene: Scene, scenario: Scenario, body: int, pose: Float) -> None:
    """Draw a body at a pose (3,), filled, if it is a robot; body: in `Scenario.bodies`."""
    if body < len(scenario.robots):
        color = scenario.colors[body]
        _draw_member(scene, scenario, scenario.robots[body], pose, color, "#ffffff")


def place_prop(scene: Scene, scenario: Scenario, body: int, pose: Float) -> None:
    """Draw a body at a pose (3,), filled, if it is a prop; body: in `Scenario.bodies`."""
    if body >= len(scenario.robots):
        prop = scenario.props[body - len(scenario.robots)]
        draw_prop(scene, prop, pose, prop_color(prop))


def _draw_member(
    scene: Scene, scenario: Scenario, robot: Robot, pose: Float, fill: str | None, stroke: str
) -> None:
    """Draw a robot of a team to scale, or as a point where the animation wants that."""
    if scenario.animation.show_real_shape:
        draw_robot(scene, robot, pose, fill, stroke)
    else:
        scene.circle(pose[:2], 0.0, fill=fill, stroke=stroke, pixels=5.0)


def initial_poses(frame: Frame) -> Scene:
    """Return the props and robots where they started, hollow.

    That is where their paths begin: a scenario that was changed on the way has other poses.
    """
    scene, scenario = Scene(), frame.scenario
    poses, prop_poses = starts(frame)
    for prop, pose, color in zip(
        scenario.props, prop_poses.T, prop_colors(scenario.props), strict=True
    ):
        draw_prop(scene, prop, pose, color, hollow=True)
    for robot, pose, color in zip(scenario.robots, poses.T, scenario.colors, strict=True):
        _draw_member(scene, scenario, robot, pose, None, faded(color, 0.8))
    return scene


def starts(frame: Frame) -> tuple[Float, Float]:
    """Return the poses at the start of robots (3, n) and props (3, p)."""
    if len(frame.path):
        prop_poses = frame.prop_path[0] if len(frame.prop_path) else frame.prop_pose
        return frame.path[0], prop_poses
    return frame.pose, frame.prop_pose


def joints(frame: Frame) -> Scene:
    """Return the joints that act: ropes, rods, springs and the pins of hinges."""
    scene = Scene()
    if frame.scenario.ties and frame.scenario.physics == "contact":
        for tie in frame.scenario.ties:
            draw_tie(scene, tie, frame.all_poses)
    return scene


def bounding_circle(shape: Shape, pose: Float) -> tuple[Float, float]:
    """Return the centre (2,) and radius of a circle round a body at a pose (3,), metres."""
    (x, y), radius = shape.bound
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return pose[:2] + np.array([c * x - s * y, s * x + c * y]), radius


def prop_edge(color: str) -> str:
    """Return the colour of a prop's edge: a darker one."""
    return "#" + "".join(f"{round(0.45 * int(color[k : k + 2], 16)):02x}" for k in (1, 3, 5))


def draw_tie(scene: Scene, tie: AttachedJoint, poses: Float) -> None:
    """Draw the tie of two bodies, (3, bodies): a rope, rod, spring or hinge."""
    joint = tie.joint
    start = _placed([joint.anchor_a], poses[:, tie.a])[0]
    end = np.array(joint.anchor_b)
    if tie.b >= 0:
        end = _placed([joint.anchor_b], poses[:, tie.b])[0]
    with called(f"{type(joint).__name__}.draw", joint.draw):
        joint.draw(scene, start, end, tie.length)


def _draw_shape(
    scene: Scene, shape: Shape, pose: Float, fill: str | None, stroke: str, width: float
) -> None:
    """Draw the shape of a body at a pose (3,), without seams where its parts overlap."""
    if fill is None or len(shape.rims) == 1:
        for rim in _edges(shape):
            _draw_rim(scene, rim, pose, fill, stroke, width)
        return
    for rim in shape.rims:
        _draw_rim(scene, rim, pose, None, stroke, 2 * width)
    for rim in shape.rims:
        _draw_rim(scene, rim, pose, fill, None, width)


def _draw_rim(
    scene: Scene, rim: Rim, pose: Float, fill: str | None, stroke: str | None, width: float
) -> None:
    points = _placed(rim.points, pose)
    if rim.radius:
        scene.circle(points[0], rim.radius, fill=fill, stroke=stroke, width=width)
    else:
        scene.polygon(points, fill=fill, stroke=stroke, width=width)


def _placed(points: ArrayLike | Sequence[Point], pose: Float) -> Float:
    """Return where points (k, 2) of a body lie in the world when it is at a pose (3,)."""
    x, y, theta = pose.tolist()
    c, s = cos(theta), sin(theta)
    turned = np.asarray(points, dtype=float) @ np.array([[c, s], [-s, c]])
    return np.asarray(turned + np.array([x, y]))


@lru_cache(maxsize=1024)
def _region(shape: Shape) -> Any:
    """Return the region that a shape covers, for shapely; its parts are joined."""
    import shapely

    parts = [
        shapely.Point(rim.points[0]).buffer(rim.radius, quad_segs=24)
        if rim.radius
        else shapely.Polygon(rim.points)
        for rim in shape.rims
    ]
    return shapely.union_all(parts)


@lru_cache(maxsize=1024)
def _edges(shape: Shape) -> tuple[Rim, ...]:
    """Return the outline of a shape's parts together, without edges where they overlap."""
    import shapely

    if len(shape.rims) == 1:
        return shape.rims
    rings = [
        ring
        for part in shapely.get_parts(_region(shape))
        for ring in (part.exterior, *part.interiors)
    ]
    return tuple(Rim(tuple(ring.coords[:-1]), 0.0) for ring in rings)


@lru_cache(maxsize=1024)
def _ahead(shape: Shape) -> tuple[Point, Point]:
    """Return the ends of the first stretch within a shape on the x axis, from its origin on."""
    import shapely

    if isinstance(shape, Disc) and shape.center == (0.0, 0.0):
        return (0.0, 0.0), (shape.radius, 0.0)
    (x, _), radius = shape.bound
    axis = shapely.LineString([(0.0, 0.0), (max(x + radius, radius), 0.0)])
    within = shapely.get_parts(shapely.intersection(axis, _region(shape)))
    found = [part.bounds for part in within if not part.is_empty]
    first = min(found, default=(0.0, 0.0, shape.thickness / 2, 0.0))
    return (first[0], 0.0), (first[2], 0.0)


NAME_SIZE, CROWD_SIZE = 13.0, 11.0
"""The height of names, and of names in a crowd, points."""
NAME_HALO = "#ffffff"

MANY_BODIES = 20
"""Among more bodies, names are smaller, and a robot named robot12 by default is just 12."""


def draw_name(scene: Scene, scenario: Scenario, body: int, pose: Float) -> None:
    """Write the name of a body above it, at a pose (3,)."""
    bodies = scenario.bodies
    crowd, name = len(bodies) > MANY_BODIES, str(bodies[body].name)
    if crowd and name == f"robot{body}":
        name = str(body)
    x, y, _ = pose.tolist()
    size = CROWD_SIZE if crowd else NAME_SIZE
    above = y + bodies[body].shape.reach
    scene.shapes.append(Text((x, above), name, INK, size, "above", NAME_HALO))


SMALL = 0.012
"""A robot is small if its diameter is less than this share of the workspace's longer side."""

RING = 9.0
"""The radius of a ring, points. It lies below its robot, so that it is hidden where one is near."""


def place_ring(scene: Scene, scenario: Scenario, body: int, pose: Float) -> None:
    """Draw a ring at a pose (3,), if a body is a robot that would hardly be seen without."""
    if body < len(scenario.robots) and scenario.animation.show_real_shape:
        xmin, xmax, ymin, ymax = scenario.bounds
        color = scenario.colors[body]
        if 2 * scenario.robots[body].radius < SMALL * max(xmax - xmin, ymax - ymin):
            fill, stroke = faded(color, 0.2), faded(color, 0.8)
            scene.circle(pose[:2], 0.0, fill=fill, stroke=stroke, width=1.3, pixels=RING)
