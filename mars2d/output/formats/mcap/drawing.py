"""Scenes as Foxglove draws them: shapes become solids and lines of its own."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Circle, Line, Polygon, Scene, rgb

__all__ = ["draw"]

Float = NDArray[np.float64]

LAYER = 1e-3
"""How far a shape lies above the one before it, metres."""

CORNERS = 48
"""Of a ring."""


def draw(entity: Any, scene: Scene, floor: float) -> None:
    """Add a scene's discs, outlines and lines to a ``foxglove.SceneEntity``, in its frame.

    floor: the height at which the first lies, metres.
    """
    for k, shape in enumerate(scene.shapes):
        z = floor + k * LAYER
        if isinstance(shape, Circle):
            if shape.fill is not None:
                _disc(entity, shape, z)
            if shape.stroke is not None:
                angle = np.linspace(0.0, 2 * np.pi, CORNERS, endpoint=False)
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
    _put(disc.size, 2 * circle.radius, 2 * circle.radius, LAYER)
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
