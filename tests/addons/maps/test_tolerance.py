"""Nothing is off by more than the tolerance: curves are compared with their exact equations."""

from __future__ import annotations

from itertools import pairwise
from math import cos, pi, sin

import ezdxf
import numpy as np
import shapely

from mars2d.addons import Map
from tests.cases import each_case

T = np.linspace(0, 1, 4001)
SIZES = [(0.1, 0.02), (1.0, 0.001), (100.0, 0.02), (1000.0, 0.02), (1000.0, 0.3)]
"""Radii and tolerances, metres."""


def arc(rx, ry, start, end, x=0.0, y=0.0):
    """Points (k, 2) of an arc of an ellipse about (x, y), its angles in degrees."""
    q = np.deg2rad(start + (end - start) * T)
    return np.column_stack([x + rx * np.cos(q), y + ry * np.sin(q)])


def bezier(*controls):
    """Points (k, 2) of a Bezier curve of any degree."""
    points = [np.array(c, dtype=float) * np.ones((len(T), 1)) for c in controls]
    while len(points) > 1:
        points = [(1 - T)[:, None] * a + T[:, None] * b for a, b in pairwise(points)]
    return points[0]


def off(path, exact, tolerance):
    """How far the walls and outlines of a map are from the exact curve, and it from them."""
    found = Map.from_file(path, unit="m", tolerance=tolerance)
    rings = [shapely.LinearRing(outline) for outline in found.outlines]
    lines = [shapely.get_coordinates(ring) for ring in rings] + [*map(np.array, found.walls)]
    places = np.vstack([np.vstack([p[:-1], middles(p)]) for p in lines])
    return max(apart(exact, lines), apart(places, [exact]))


def middles(points):
    """The middles of the edges of a polyline (k, 2)."""
    return (points[1:] + points[:-1]) / 2


def apart(points, lines):
    """How far points (k, 2) are from the nearest of some polylines."""
    edges = np.concatenate([np.stack([line[:-1], line[1:]], axis=1) for line in lines])
    tree = shapely.STRtree(shapely.linestrings(edges))
    return tree.query_nearest(shapely.points(points), return_distance=True)[1].max()


def hatch(space, r):
    edges = space.add_hatch().paths.add_edge_path()
    edges.add_ellipse((0, 0), (r, 0), 0.5)


DXF = {
    "circle": (lambda s, r: s.add_circle((0, 0), r), lambda r: arc(r, r, 0, 360)),
    "arc": (lambda s, r: s.add_arc((0, 0), r, 20, 250), lambda r: arc(r, r, 20, 250)),
    "ellipse": (lambda s, r: s.add_ellipse((0, 0), (r, 0), 0.3), lambda r: arc(r, 0.3 * r, 0, 360)),
    "bulge": (
        lambda s, r: s.add_lwpolyline([(r, 0, 1), (-r, 0, 0)], format="xyb"),
        lambda r: arc(r, r, 0, 180),
    ),
    "spline": (
        lambda s, r: s.add_open_spline([(0, 0), (r, r), (2 * r, -r), (3 * r, 0)]),
        lambda r: bezier((0, 0), (r, r), (2 * r, -r), (3 * r, 0)),
    ),
    "rational spline": (
        lambda s, r: s.add_rational_spline([(r, 0), (r, r), (0, r)], [1, cos(pi / 4), 1], 2),
        lambda r: arc(r, r, 0, 90),
    ),
    "hatch": (hatch, lambda r: arc(r, 0.5 * r, 0, 360)),
}


@each_case("name", DXF)
def test_curves_of_a_dxf(tmp_path, name):
    draw, exact = DXF[name]
    for radius, tolerance in SIZES:
        document = ezdxf.new("R2010", units=6)
        draw(document.modelspace(), radius)
        document.saveas(tmp_path / "curve.dxf")
        assert off(tmp_path / "curve.dxf", exact(radius), tolerance) <= tolerance + 1e-6 * radius


SVG = {
    "circle": ('<circle r="{r}"/>', lambda r: arc(r, r, 0, 360)),
    "ellipse": ('<ellipse rx="{r}" ry="50%"/>', lambda r: arc(r, 0.5 * r, 0, 360)),
    "arc": (
        '<path d="M{r} 0A{r} {r} 0 1 1 {x} {y}"/>',
        lambda r: arc(r, r, 0, -200),
    ),
    "turned": (
        '<g transform="rotate(40) scale(2 1)"><circle r="{r}"/></g>',
        lambda r: arc(2 * r, r, 0, 360) @ [[cos(0.698131700798), -sin(0.698131700798)],
                                           [sin(0.698131700798), cos(0.698131700798)]],
    ),
    "cubic": (
        '<path d="M0 0C{r} {r} {r} -{r} 0 -{r}"/>',
        lambda r: bezier((0, 0), (r, -r), (r, r), (0, r)),
    ),
    "quadratic": ('<path d="M0 0Q{r} {r} 0 -{r}"/>', lambda r: bezier((0, 0), (r, -r), (0, r))),
    "almost a circle": (
        '<path d="M{r} 0C{r} {k} {k} {r} 0 {r}"/>',
        lambda r: bezier((r, 0), (r, -0.5522847 * r), (0.5522847 * r, -r), (0, -r)),
    ),
}  # fmt: skip


@each_case("name", SVG)
def test_curves_of_an_svg(tmp_path, name):
    content, exact = SVG[name]
    for r, tolerance in SIZES:
        end = {"x": r * cos(pi * 200 / 180), "y": r * sin(pi * 200 / 180), "k": 0.5522847 * r}
        head = f'xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {r} {r}" fill="none" stroke="red"'
        (tmp_path / "curve.svg").write_text(f"<svg {head}>{content.format(r=r, **end)}</svg>")
        curve = exact(r) + np.array((0, r))  # the page's lower edge is at y = 0
        assert off(tmp_path / "curve.svg", curve, tolerance) <= tolerance + 1e-6 * r


def test_a_tolerance_of_zero_keeps_all_corners_and_fine_curves(tmp_path):
    document = ezdxf.new("R2010", units=6)
    document.modelspace().add_circle((0, 0), 10)
    document.saveas(tmp_path / "curve.dxf")
    assert off(tmp_path / "curve.dxf", arc(10, 10, 0, 360), 0) <= 1.2e-4
