"""Free room among obstacles: where a body can stand."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.geometry import Outline, Point

__all__ = ["nearest_room"]


def nearest_room(
    place: Point, radius: float, outlines: Sequence[Outline], workspace: Outline
) -> Point | None:
    """Return the point nearest to a place where a disc stands within a workspace, off obstacles.

    place: (x, y) [m]; it is returned as it is if the disc stands there. radius: that of the disc
    [m]. None: there is no room for it.
    """
    import shapely

    where = shapely.Point(place)
    shapes = [shapely.LineString(o) if len(o) == 2 else shapely.Polygon(o) for o in outlines]
    taken = shapely.union_all(shapely.buffer(shapes, radius, quad_segs=4))
    free = shapely.difference(shapely.Polygon(workspace), taken)
    if shapely.covers(free, where):
        return place
    inner = shapely.buffer(free, -0.05 * radius)  # not just beside a wall
    if inner.is_empty:
        return None
    _, nearest = shapely.shortest_line(where, inner).coords
    return float(nearest[0]), float(nearest[1])
