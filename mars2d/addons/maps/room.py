"""Free room among obstacles: where a body can stand."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.core.plane import Outline, Point, lines_and_areas

__all__ = ["nearest_room"]

SPARE = (4.0, 1.0, 0.05)
"""How far from walls a disc is to stand, in its radii, if there is such a place."""

LEAST = 0.03
"""Rooms that are smaller than this share of the largest one are nooks, where none is to stand."""


def nearest_room(
    place: Point, radius: float, outlines: Sequence[Outline], workspace: Outline
) -> Point | None:
    """Return the point nearest to a place where a disc stands within a workspace, off obstacles.

    place: (x, y) [m]; it is returned as it is if the disc stands there. radius: that of the disc
    [m]. Where there is room to turn and drive, that is preferred to a gap or a corner. None: there
    is no room for it.
    """
    import shapely

    where = shapely.Point(place)
    shapes = lines_and_areas(outlines)
    taken = shapely.union_all(shapely.buffer(shapes, radius, quad_segs=4))
    free = shapely.difference(shapely.Polygon(workspace), taken)
    if shapely.covers(free, where):
        return place
    for spare in SPARE:
        inner = shapely.buffer(free, -spare * radius)
        if not inner.is_empty:
            parts = shapely.get_parts(inner)
            areas = shapely.area(parts)
            rooms = shapely.multipolygons(parts[areas >= LEAST * areas.max()])
            _, nearest = shapely.shortest_line(where, rooms).coords
            return float(nearest[0]), float(nearest[1])
    return None
