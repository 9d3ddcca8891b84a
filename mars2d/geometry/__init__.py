"""Algorithms of the plane, and the shapes of bodies.

The basic functions of the plane are in `mars2d.core.plane`, and exported here as well.
"""

from mars2d.core.plane import (
    Outline,
    Point,
    bounds_of,
    distance_to_ring,
    edges_of,
    inside_polygon,
    outside_polygon,
    point_segment_distance,
    rectangle,
    wrap,
)
from mars2d.geometry.dominance import dominance
from mars2d.geometry.potential_field import Potential
from mars2d.geometry.shapes import Compound, Disc, Polygon, Shape
from mars2d.geometry.voronoi import Tessellation

__all__ = [
    "Compound",
    "Disc",
    "Outline",
    "Point",
    "Polygon",
    "Potential",
    "Shape",
    "Tessellation",
    "bounds_of",
    "distance_to_ring",
    "dominance",
    "edges_of",
    "inside_polygon",
    "outside_polygon",
    "point_segment_distance",
    "rectangle",
    "wrap",
]
