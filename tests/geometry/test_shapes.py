"""Shapes are cut into convex pieces that fit, and weigh what the textbook says."""

from __future__ import annotations

from math import asinh, cos, hypot, pi, sin, sqrt

import numpy as np
import pymunk
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from mars2d.core.errors import InputError
from mars2d.geometry.shapes import MAX_VERTICES, Compound, Disc, Piece, Polygon, Rim
from tests.cases import each_case

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


def _comb(teeth):
    """A bar with `teeth` upright teeth: clockwise along the top, closed by the bar's underside."""
    tops = [[(2 * k, 1), (2 * k, 3), (2 * k + 1, 3), (2 * k + 1, 1)] for k in range(teeth)]
    top = [point for tooth in tops for point in tooth][1:-1]
    return [(0, 0), *top, (2 * teeth - 1, 0)]


def _star(tips, inner):
    radii = [1.0 if k % 2 == 0 else inner for k in range(2 * tips)]
    angles = [pi * k / tips for k in range(2 * tips)]
    return [(r * cos(a), r * sin(a)) for r, a in zip(radii, angles, strict=True)]


def _spiral(points, turns):
    angles = [2 * pi * turns * k / (points - 1) for k in range(points)]
    inner = [((1 + a) * cos(a), (1 + a) * sin(a)) for a in angles]
    outer = [((3 + a) * cos(a), (3 + a) * sin(a)) for a in angles]
    return [*inner, *outer[::-1]]


def _arc(points):
    angles = [pi * k / (points - 1) for k in range(points)]
    outer = [(cos(a), sin(a)) for a in angles]
    return [*outer, *((0.8 * x, 0.8 * y) for x, y in outer[::-1])]


ELL = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
YOU = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]
TEE = [(0, 2), (0, 3), (3, 3), (3, 2), (2, 2), (2, 0), (1, 0), (1, 2)]
PLUS = [(1, 0), (2, 0), (2, 1), (3, 1), (3, 2), (2, 2), (2, 3), (1, 3), (1, 2), (0, 2), (0, 1),
        (1, 1)]  # fmt: skip
MARS = [(5, 2), (4, 3), (6, 4), (5, 3)]  # an obstacle of the paper, concave

# The outline, and the fewest convex pieces between its vertices.
KNOWN = {
    "ell": (ELL, 2),
    "you": (YOU, 3),
    "tee": (TEE, 2),
    "plus": (PLUS, 3),
    "mars": (MARS, 2),
    "comb": (_comb(5), 6),
    "star": (_star(5, 0.4), 3),
    "spiral": (_spiral(28, 2), 27),
    "arc": (_arc(24), 23),
    "triangle": (SQUARE[:3], 1),
    "square": (SQUARE, 1),
    "round": (_star(16, 1.0), 1),
}


def _area(vertices):
    x, y = np.array(vertices).T - np.array([vertices[0]]).T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


def _bends(vertices):
    """The sine of the turn at each vertex."""
    ring = np.array(vertices)
    come, go = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    turn = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0]
    return turn / np.hypot(*come.T) / np.hypot(*go.T)


def _assert_pieces_fit(shape):
    polygons = [shapely.Polygon(piece.vertices) for piece in shape.pieces]
    whole = shapely.Polygon(shape.outline)
    for piece in shape.pieces:
        assert piece.radius == 0
        assert set(piece.vertices) <= set(shape.outline)  # no new points
        assert (_bends(piece.vertices) > 0).all()  # convex and counter-clockwise, nothing straight
        held = pymunk.Poly(pymunk.Body(), piece.vertices).get_vertices()
        assert len(held) == len(piece.vertices)  # the engine's hull is the piece
    together = shapely.union_all(polygons)
    assert sum(polygon.area for polygon in polygons) == pytest.approx(whole.area, rel=1e-12)
    assert together.area == pytest.approx(whole.area, rel=1e-12)  # so none overlaps another
    assert together.symmetric_difference(whole).area <= 1e-12 * whole.area


@each_case("name", KNOWN)
@each_case("way", [1, -1])
def test_an_outline_is_cut_into_few_convex_pieces(name, way):
    outline, fewest = KNOWN[name]
    shape = Polygon(outline[::way])
    _assert_pieces_fit(shape)
    assert fewest <= len(shape.pieces) <= 2 * fewest
    assert shape.area == pytest.approx(abs(_area(outline)), rel=1e-14)


@given(
    steps=st.lists(st.floats(0.2, 1.0), min_size=5, max_size=30),
    radii=st.lists(st.floats(0.2, 1.0), min_size=30, max_size=30),
    offset=st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
    way=st.sampled_from([1, -1]),
)
@settings(max_examples=20, deadline=None)
def test_the_pieces_of_any_star_shaped_outline_fit(steps, radii, offset, way):
    angles = 2 * pi * np.cumsum(steps) / sum(steps)
    around = zip(angles.tolist(), radii, strict=False)
    outline = [(r * cos(a) + offset[0], r * sin(a) + offset[1]) for a, r in around]
    try:
        shape = Polygon(outline[::way])
    except InputError as error:
        assert "thickness" in str(error)  # noqa: PT017
        return
    _assert_pieces_fit(shape)


@each_case("noise", [0, 1e-16, 1e-14, 1e-13, 1e-10, 1e-6, 1e-3])
def test_corners_that_nearly_line_up_make_no_slivers(noise):
    rng = np.random.default_rng(3)
    for angle in np.linspace(0, pi, 12):
        turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
        shape = Polygon((np.array(PLUS) + noise * rng.normal(size=(12, 2))) @ turn.T)
        _assert_pieces_fit(shape)
        assert len(shape.pieces) <= 6
        assert shape.thickness > 0.7


def test_vertices_on_a_straight_side_are_drawn_but_do_not_reach_the_engine():
    shape = Polygon([(0, 0), (0.5, 0), (1, 0), (1, 0.3), (1, 1), (0, 1), (0, 0.1)])
    assert shape.pieces == (Piece(((0, 0), (1, 0), (1, 1), (0, 1)), 0.0),)
    assert shape.rims == (Rim(shape.outline, 0.0),)
    assert len(shape.outline) == 7


@each_case(
    ("outline", "problem"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "crosses or touches itself"),
        ([(0, 0), (1, 0), (2, 0)], "lie on one line"),
        ([(0, 0), (1, 0)], "at least 3"),
        ("square", "polygon's vertices"),
        (_star(40, 0.9), f"has 80 vertices: expected at most {MAX_VERTICES}"),
        ([(0, 0), (1, 0), (0.5, 9e-5)], "thickness"),
    ],
)
def test_an_outline_that_the_engine_can_not_hold_is_refused(outline, problem):
    with pytest.raises(InputError, match=problem) as error:
        Polygon(outline)
    assert "Polygon.outline" in str(error.value)


@each_case("parts", [[], Disc(0.2), [SQUARE], None, [Disc], [Disc(0.2)] * 65])
def test_a_compound_is_made_of_shapes(parts):
    with pytest.raises(InputError, match=r"^Compound.parts"):
        Compound(parts)


def _rectangle(a, b):
    return [(-a / 2, -b / 2), (a / 2, -b / 2), (a / 2, b / 2), (-a / 2, b / 2)]


def test_a_disc_has_the_textbooks_moment_and_two_thirds_of_its_radius_as_lever():
    shape = Disc(0.6)
    assert shape.area == pytest.approx(pi * 0.09)
    assert shape.plate.moment_per_mass == pytest.approx(0.3**2 / 2)
    assert shape.plate.lever == pytest.approx(0.2)
    assert (shape.bound, shape.thickness) == (((0, 0), 0.3), 0.6)
    assert shape.moved(3, 4).plate.moment_per_mass == pytest.approx(0.3**2 / 2 + 25)


@each_case(("a", "b"), [(1, 1), (2, 1), (0.06, 1), (1000, 0.001)])
def test_a_rectangle_has_the_textbooks_moment_and_lever(a, b):
    shape = Polygon(_rectangle(a, b))
    d = hypot(a, b)
    lever = d / 6 + a * a / (12 * b) * asinh(b / a) + b * b / (12 * a) * asinh(a / b)
    assert shape.area == pytest.approx(a * b, rel=1e-14)
    assert shape.plate.moment_per_mass == pytest.approx((a * a + b * b) / 12, rel=1e-13)
    assert shape.plate.lever == pytest.approx(lever, rel=1e-12)
    assert shape.thickness == pytest.approx(min(a, b), rel=1e-14)
    assert shape.bound[1] == pytest.approx(d / 2, rel=1e-12)


def _grid(shape, count):
    """Points inside a shape on a grid of `count` a side, askew to its sides; a cell's area."""
    (x, y), radius = shape.bound
    along = ((np.arange(count) + 0.5) / count - 0.5) * 2 * sqrt(2) * radius
    u, v = (w.ravel() for w in np.meshgrid(along, along))
    px, py = x + u * cos(0.3) - v * sin(0.3), y + u * sin(0.3) + v * cos(0.3)
    inside = np.zeros(len(px), dtype=bool)
    for vertices, r in shape.pieces:
        if r:
            inside |= np.hypot(px - vertices[0][0], py - vertices[0][1]) < r
        else:
            inside |= shapely.contains_xy(shapely.Polygon(vertices), px, py)
    return px[inside], py[inside], (along[1] - along[0]) ** 2


ANY = {
    **{name: Polygon(outline) for name, (outline, _) in KNOWN.items()},
    "moved": Polygon(ELL).moved(20, -30),
    "overlapping discs": Compound([Disc(1.0), Disc(0.6).moved(0.5, 0.2)]),
    "keyhole": Compound([Disc(1.0), Polygon(_rectangle(0.3, 2)).moved(0, -0.8)]),
    "touching": Compound([Polygon(SQUARE), Polygon(SQUARE).moved(1, 0.5)]),
    "frame": Compound(
        [Polygon(_rectangle(2, 0.2)).moved(0, y) for y in (-0.9, 0.9)]
        + [Polygon(_rectangle(0.2, 2)).moved(x, 0) for x in (-0.9, 0.9)]
    ),
    "apart": Compound([Disc(0.4).moved(-1, 0), Polygon(SQUARE).moved(1, 0)]),
}


@each_case("name", ANY)
def test_mass_properties_agree_with_a_count_of_grid_points(name):
    shape = ANY[name]
    x, y, cell = _grid(shape, 300)
    cx, cy = shape.centroid
    size = shape.bound[1]
    assert shape.area == pytest.approx(len(x) * cell, rel=3e-3)
    assert (cx, cy) == pytest.approx((x.mean(), y.mean()), abs=3e-3 * size)
    assert shape.plate.moment_per_mass == pytest.approx((x * x + y * y).mean(), rel=3e-3)
    assert shape.plate.lever == pytest.approx(np.hypot(x - cx, y - cy).mean(), rel=3e-3)


@each_case("name", ANY)
def test_the_bound_holds_the_shape_and_is_not_loose(name):
    shape = ANY[name]
    (x, y), radius = shape.bound
    reaches = [
        hypot(px - x, py - y) + piece.radius for piece in shape.pieces for px, py in piece.vertices
    ]
    assert max(reaches) <= radius
    discs = [shapely.Point(p.vertices[0]).buffer(p.radius) for p in shape.pieces if p.radius]
    polygons = [shapely.Polygon(piece.vertices) for piece in shape.pieces if not piece.radius]
    region = shapely.union_all([*discs, *polygons])
    assert radius <= shapely.minimum_bounding_radius(region) * (1 + 2e-3)


@each_case("name", ANY)
def test_a_moved_shape_is_the_same_shape_elsewhere(name):
    shape = ANY[name]
    moved = shape.moved(3.0, -4.0)
    (x, y), (u, v) = shape.centroid, moved.centroid
    assert type(moved) is type(shape)
    assert (u - x, v - y) == pytest.approx((3, -4), abs=1e-12)
    assert moved.area == pytest.approx(shape.area, rel=1e-11)
    assert moved.plate.lever == pytest.approx(shape.plate.lever, rel=1e-11)
    assert moved.thickness == pytest.approx(shape.thickness, rel=1e-11)
    assert moved.bound[1] == pytest.approx(shape.bound[1], rel=1e-11)
    about_centroid = shape.plate.moment_per_mass - x * x - y * y
    assert moved.plate.moment_per_mass - u * u - v * v == pytest.approx(about_centroid, rel=1e-9)
