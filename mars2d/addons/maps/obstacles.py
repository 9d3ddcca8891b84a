"""From a drawing to obstacles: merged, simplified, and cut so that none has a hole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mars2d.addons.maps.drawing import Drawing
from mars2d.addons.maps.regions import GRID, joined
from mars2d.addons.maps.simplify import simple_area, simple_line
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError
from mars2d.core.plane import Outline

if TYPE_CHECKING:
    import shapely

__all__ = ["TOLERANCE", "Obstacles", "obstacles"]

TOLERANCE = 0.02
"""How far corners may move to have fewer of them, unless somebody says so, metres."""

MOST_CORNERS = 20_000
"""A map has no more corners than this: an engine's step must stay quick."""

LARGEST_TOLERANCE = 10.0

SMALLEST = 1e-6
"""Outlines of less area are no obstacles, square metres."""


@dataclass(frozen=True)
class Obstacles:
    """What stands in the way: closed outlines, and walls of two or more corners [m]."""

    outlines: tuple[Outline, ...]
    walls: tuple[Outline, ...]

    @property
    def corners(self) -> int:
        """How many corners all of them have together."""
        return sum(map(len, (*self.outlines, *self.walls)))


def obstacles(drawing: Drawing, tolerance: float = TOLERANCE) -> Obstacles:
    """Return the obstacles of a drawing; they differ from it by no more than `tolerance` metres.

    Areas that touch are merged, and cut open where there is room inside, so that it stays free.
    What is drawn twice counts once. Raises InputError for too many corners, or if none is left.
    """
    import shapely

    tolerance = tolerance_of(tolerance)
    geometries = [piece.geometry for piece in drawing.pieces]
    solid = [g for g in geometries if g.geom_type == "Polygon"]
    areas = solid if drawing.apart else joined(drawing.source, solid)
    _check_corners(drawing.source, 3 * len(areas), tolerance)  # a triangle each, at least
    simple = shapely.get_parts(
        shapely.set_precision([simple_area(area, tolerance) for area in areas], GRID)
    )
    outlines = tuple(
        tuple(map(tuple, shapely.get_coordinates(part)[:-1].tolist()))
        for area in simple.tolist()
        if area.area > SMALLEST
        for part in _without_holes(area)
    )
    lines = [g for g in geometries if g.geom_type == "LineString"]
    walls = tuple(
        tuple(map(tuple, shapely.get_coordinates(line).tolist()))
        for line in _merged(lines, tolerance)
    )
    found = Obstacles(outlines, walls)
    _check_corners(drawing.source, found.corners, tolerance)
    if not found.corners:
        raise InputError(f"{drawing.source}: nothing is left of it; is the unit right?")
    return found


def _check_corners(name: str, count: int, tolerance: float) -> None:
    if count > MOST_CORNERS:
        raise InputError(
            f"{name}: {count} corners or more, expected at most {MOST_CORNERS}: "
            f"choose fewer layers, or a tolerance above {tolerance:g} m"
        )


def tolerance_of(value: object) -> float:
    """Check a tolerance [m]."""
    expected = f"metres, a number >= 0 and <= {LARGEST_TOLERANCE:g}"
    result = real("tolerance", value, expected)
    if not 0 <= result <= LARGEST_TOLERANCE:
        raise wrong("tolerance", value, expected)
    return result


def _without_holes(area: shapely.Polygon) -> list[shapely.Polygon]:
    """Return an area as polygons without holes, cut above and below each of its holes.

    A cut goes from the topmost corner of a hole straight up to the next edge, and another one from
    its lowest corner down. Upwards, each hole leads to a higher edge and so at last to the rim;
    downwards as well. So whatever cut is taken away, all edges still hang together: each cut
    parts two pieces, and none has a hole, unless cuts meet in a corner; then it is cut again.
    """
    import shapely

    if not len(area.interiors):
        return [area]
    cuts = [shapely.LineString(ring.coords) for ring in (area.exterior, *area.interiors)]
    cuts += [cut for hole in area.interiors for cut in _cuts(area, hole)]
    edges = shapely.get_parts(shapely.union_all(cuts, grid_size=GRID))
    faces = shapely.get_parts(shapely.polygonize(edges))
    shapely.prepare(area)
    inside = shapely.contains(area, shapely.point_on_surface(faces))
    pieces = [face for face in faces[inside].tolist() if face.area > SMALLEST]
    if any(len(piece.interiors) >= len(area.interiors) for piece in pieces):
        pieces = _halves(area)  # nothing was won
    return [part for piece in pieces for part in _without_holes(piece)]


def _cuts(area: shapely.Polygon, hole: shapely.LinearRing) -> list[shapely.LineString]:
    """Return a cut from a hole's topmost corner up to the next edge, and one from its lowest."""
    import shapely

    points = shapely.get_coordinates(hole)
    _, low, _, high = area.bounds
    found = []
    for corner, end in ((points[:, 1].argmax(), high + 1), (points[:, 1].argmin(), low - 1)):
        x, y = points[corner]
        line = shapely.intersection(area, shapely.LineString([(x, y), (x, end)]))
        parts = shapely.get_parts(line)
        near = shapely.distance(parts, shapely.Point(x, y)) < GRID
        found += [part for part in parts[near].tolist() if part.geom_type == "LineString"]
    return found


def _halves(area: shapely.Polygon) -> list[shapely.Polygon]:
    """Return the two sides of an area, cut along a line through the middle of its first hole."""
    import shapely

    xmin, ymin, xmax, ymax = area.bounds
    left, _, right, _ = area.interiors[0].bounds
    middle = (left + right) / 2
    boxes = [shapely.box(xmin, ymin, middle, ymax), shapely.box(middle, ymin, xmax, ymax)]
    halves = shapely.get_parts(shapely.intersection(area, boxes, grid_size=GRID)).tolist()
    return [half for half in halves if half.geom_type == "Polygon" and half.area > SMALLEST]


def _merged(lines: list[shapely.LineString], tolerance: float) -> list[shapely.LineString]:
    """Return lines that meet end to end as one, each edge once, with fewer corners."""
    import shapely

    if not lines:
        return []
    points, line = shapely.get_coordinates(lines, return_index=True)
    places = np.round(points / GRID).astype(np.int64)
    ends = np.hstack([places[:-1], places[1:]])[line[1:] == line[:-1]]
    back = ends[:, [2, 3, 0, 1]]
    x1, y1, x2, y2 = ends.T
    edges = np.unique(np.where(((x1 > x2) | ((x1 == x2) & (y1 > y2)))[:, None], back, ends), axis=0)
    edges = edges[(edges[:, :2] != edges[:, 2:]).any(axis=1)]
    if not len(edges):
        return []
    parts = shapely.linestrings(edges.reshape(-1, 2, 2) * GRID)
    merged = shapely.line_merge(shapely.multilinestrings(parts))
    found = shapely.get_parts(merged)
    simple = [shapely.LineString(simple_line(np.array(line.coords), tolerance)) for line in found]
    rounded = shapely.get_parts(shapely.set_precision(simple, GRID, mode="pointwise"))
    clean = shapely.remove_repeated_points(rounded, GRID / 2)
    return [part for part in clean.tolist() if part.length > GRID]
