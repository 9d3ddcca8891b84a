"""The obstacles of a drawing: merged, simplified, cut so that none has a hole, and described."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mars2d.addons.maps.drawing import COARSER, MAX_TOLERANCE, Drawing, listed
from mars2d.addons.maps.regions import GRID, joined, simple_area, simple_line
from mars2d.core.errors import InputError, counted
from mars2d.core.plane import Outline

if TYPE_CHECKING:
    import shapely

MAX_CORNERS = 20_000
"""The most corners of a map: a step of the engine must stay quick."""

MIN_AREA = 1e-6
"""The area below which an outline is no obstacle, m^2."""

MAX_LAYERS = 24
"""The most layers that a description names."""


@dataclass(frozen=True)
class Obstacles:
    """Closed outlines, and walls of two or more corners [m]."""

    outlines: tuple[Outline, ...]
    walls: tuple[Outline, ...]

    @property
    def corners(self) -> int:
        """The number of corners of all of them."""
        return sum(map(len, (*self.outlines, *self.walls)))


def obstacles(drawing: Drawing) -> Obstacles:
    """Return the obstacles of a drawing; they differ from it by no more than its tolerance.

    Areas that touch are merged, and cut open where there is room inside, so that it stays free. A
    line or area that is drawn twice counts once. Raises InputError for too many corners, or if none
    is left.
    """
    import shapely

    tolerance = max(drawing.tolerance - drawing.within, 0.0)
    geometries = [piece.geometry for piece in drawing.pieces]
    solid = [g for g in geometries if g.geom_type == "Polygon"]
    areas = solid if drawing.apart else joined(solid)
    least = 3 * len(areas)  # a triangle each
    _check_corners(drawing, least, least)
    simple = shapely.get_parts(
        shapely.set_precision([simple_area(area, tolerance) for area in areas], GRID)
    )
    outlines = tuple(
        tuple(map(tuple, shapely.get_coordinates(part)[:-1].tolist()))
        for area in simple.tolist()
        if area.area > MIN_AREA
        for part in _without_holes(area)
    )
    lines = [g for g in geometries if g.geom_type == "LineString"]
    walls = tuple(
        tuple(map(tuple, shapely.get_coordinates(line).tolist()))
        for line in _merged(lines, tolerance)
    )
    found = Obstacles(outlines, walls)
    _check_corners(drawing, found.corners, least)
    if not found.corners and drawing.extent is None:
        raise InputError(f"{drawing.source}: nothing is left of it; is the unit right?")
    return found


def _check_corners(drawing: Drawing, count: int, least: int) -> None:
    """Raise InputError for too many corners, with advice. least: those of any tolerance."""
    if count <= MAX_CORNERS:
        return
    advice = [COARSER] if drawing.extent else []
    if len(drawing.layers) > 1:
        advice.append("choose fewer layers")
    if least <= MAX_CORNERS and drawing.tolerance < MAX_TOLERANCE:
        advice.append(f"choose a tolerance above {drawing.tolerance:g} m")
    raise InputError(
        f"{drawing.source}: {count} corners or more, expected at most {MAX_CORNERS}: "
        f"{', or '.join(advice) or 'leave some of it out'}"
    )


def _without_holes(area: shapely.Polygon) -> list[shapely.Polygon]:
    """Return an area as polygons without holes, cut upright through the middles of its holes."""
    import shapely

    if not len(area.interiors):
        return [area]
    xmin, ymin, xmax, ymax = area.bounds
    left, _, right, _ = area.interiors[0].bounds
    middle = (left + right) / 2
    boxes = [shapely.box(xmin, ymin, middle, ymax), shapely.box(middle, ymin, xmax, ymax)]
    halves = shapely.get_parts(shapely.intersection(area, boxes, grid_size=GRID)).tolist()
    found = [half for half in halves if half.geom_type == "Polygon" and half.area > MIN_AREA]
    return [part for half in found for part in _without_holes(half)]


def _merged(lines: list[shapely.LineString], tolerance: float) -> list[shapely.LineString]:
    """Return lines that meet end to end as one, each edge once, with fewer corners."""
    import shapely

    points, line = shapely.get_coordinates(lines, return_index=True)
    places = np.round(points / GRID) @ (1, 1j)
    ends = np.column_stack([places[:-1], places[1:]])[line[1:] == line[:-1]]
    edges = np.unique(np.sort(ends), axis=0)
    edges = edges[edges[:, 0] != edges[:, 1]]
    parts = shapely.linestrings(np.stack([edges.real, edges.imag], axis=-1) * GRID)
    merged = shapely.get_parts(shapely.line_merge(shapely.multilinestrings(parts)))
    simple = [shapely.LineString(simple_line(np.array(line.coords), tolerance)) for line in merged]
    rounded = shapely.get_parts(shapely.set_precision(simple, GRID, mode="pointwise"))
    clean = shapely.remove_repeated_points(rounded, GRID / 2)
    return [part for part in clean.tolist() if part.length > GRID]


def described(drawing: Drawing, found: Obstacles) -> list[tuple[str, str]]:
    """Return a description of a map and its obstacles, as pairs of a name and a text."""
    (width, height), (xmin, xmax, ymin, ymax) = drawing.size, drawing.bounds
    unit = f"{drawing.unit.name}, {drawing.unit.source}"
    parts = [(len(found.outlines), "outline"), (len(found.walls), "wall")]
    counts = ", ".join(counted(count, thing) for count, thing in parts if count)
    rows = [
        ("map", f"{drawing.source}, {drawing.kind}"),
        ("size", f"{width:.4g} m x {height:.4g} m"),
        ("from, to", f"({xmin:.5g}, {ymin:.5g}), ({xmax:.5g}, {ymax:.5g})"),
        ("unit", unit if drawing.unit.name else drawing.unit.source),
        ("hint", drawing.hint),
        *drawing.notes,
        *_layers(drawing),
        ("not read", listed(drawing.skipped)),
        ("obstacles", counts or "none"),
        ("corners", f"{found.corners}, within {drawing.tolerance:g} m"),
    ]
    return [(name, text) for name, text in rows if text]


def _layers(drawing: Drawing) -> list[tuple[str, str]]:
    """Return a row for each layer: those that were read, then the others."""
    both = [(name, count, "") for name, count in drawing.layers.items()]
    for name, count in drawing.others.items():
        hidden = "hidden, " if name in drawing.hidden else ""
        both.append((name, count, f" ({hidden}not read)"))
    if len(both) < 2:
        return []
    width = max(len(name) for name, _, _ in both[:MAX_LAYERS])
    rows = [
        ("" if k else "layers", f"{name:<{width}}  {counted(count, 'piece')}{more}")
        for k, (name, count, more) in enumerate(both[:MAX_LAYERS])
    ]
    rest = sum(count for _, count, _ in both[MAX_LAYERS:])
    more = [("", f"and {len(both) - MAX_LAYERS} more, {counted(rest, 'piece')}")] if rest else []
    return [*rows, *more]
