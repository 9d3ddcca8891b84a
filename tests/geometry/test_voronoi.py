"""Voronoi cells and integrals over them, against sampling, closed forms and differences."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from mars2d import InputError
from mars2d.geometry.voronoi import Tessellation
from tests.cases import each_case

SQUARE = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))
DISC = tuple((2 + 2 * cos(k * pi / 20), 2 + 2 * sin(k * pi / 20)) for k in range(40))
HOOK = (
    (0.0, 0.0), (4.0, 0.0), (4.0, 1.5), (1.5, 1.5), (1.5, 2.5), (4.0, 2.5), (4.0, 4.0), (0.0, 4.0),
)  # fmt: skip
REGIONS = {"square": SQUARE, "disc": DISC, "hook": HOOK}


def bump(x, y):
    return 0.2 + 1 / (1 + (x - 1) ** 2 + (y - 3) ** 2)


def grid_of(region, step=0.02):
    """Points (2, m) evenly spread over a region, each standing for step^2 of it."""
    at = np.arange(step / 2, 4, step)
    x, y = (axis.ravel() for axis in np.meshgrid(at, at))
    inside = shapely.contains_xy(shapely.Polygon(region), x, y)
    return np.array([x[inside], y[inside]]), step * step


def sampled(points, region, phi=None):
    """Masses (n,), centroids (2, n) and the cost, by what is nearest to each of many places."""
    points = np.asarray(points, dtype=float)
    places, each = grid_of(region)
    squares = ((places[:, :, None] - points[:, None]) ** 2).sum(axis=0)
    nearest = squares.argmin(axis=1)
    weight = each * (np.ones(places.shape[1]) if phi is None else phi(*places))
    mass = np.bincount(nearest, weight, points.shape[1])
    first = [np.bincount(nearest, weight * axis, points.shape[1]) for axis in places]
    return mass, np.array(first) / np.maximum(mass, 1e-12), float(weight @ squares.min(axis=1))


@each_case("phi", [None, bump])
@each_case("region", REGIONS)
def test_cells_hold_what_is_nearest_to_their_points(region, phi):
    points = np.random.default_rng(3).uniform(0.1, 3.9, (2, 9))  # some outside of disc and hook
    found = Tessellation(points, REGIONS[region], phi)
    mass, centroid, cost = sampled(points, REGIONS[region], phi)
    assert found.masses == pytest.approx(mass, abs=0.03)
    large = mass > 0.2
    assert found.centroids[:, large] == pytest.approx(centroid[:, large], abs=0.03)
    assert found.cost == pytest.approx(cost, rel=5e-3)


def test_points_on_a_square_grid_have_squares_and_the_cost_of_the_closed_form():
    at = [0.5, 1.5, 2.5, 3.5]
    points = np.array([(x, y) for y in at for x in at]).T  # four cells meet at each inner corner
    found = Tessellation(points, SQUARE)
    assert found.areas == pytest.approx(np.ones(16), rel=1e-12)
    assert found.centroids == pytest.approx(points, abs=1e-12)
    assert found.cost == pytest.approx(16 / 6, rel=1e-12)  # of a unit square: 1/6
    assert found.neighbours(5) == (1, 4, 6, 9)  # corners are no edges
    assert found.neighbours(0) == (1, 4)
    assert found.edge(5, 10) is None
    assert np.array(sorted(found.edge(6, 5))) == pytest.approx(np.array([(2, 1), (2, 2)]))


def test_of_points_at_the_same_place_the_first_has_the_cell():
    found = Tessellation([[1, 3, 1, 1], [2, 2, 2, 2]], SQUARE)
    assert found.areas.tolist() == pytest.approx([8, 8, 0, 0])
    assert found.centroids.T.tolist()[2:] == [[1, 2], [1, 2]]
    assert (found.cells[2].is_empty, found.neighbours(2), found.edge(1, 2)) == (True, (), None)
    assert found.cost == Tessellation([[1, 3], [2, 2]], SQUARE).cost
    assert Tessellation([[1, 1], [1, 1]], SQUARE).areas.tolist() == pytest.approx([16, 0])


def test_points_outside_of_the_region_have_what_of_it_is_nearest_to_them():
    found = Tessellation([[-1, 2, 50], [2, 2, 60]], SQUARE)
    assert found.areas == pytest.approx([2, 14, 0])
    assert found.centroids[:, 0] == pytest.approx([0.25, 2])
    assert found.centroids[:, 2].tolist() == [50, 60]
    assert Tessellation([[-1e5], [1e5]], SQUARE).areas == pytest.approx([16])


def test_in_a_region_that_is_not_convex_a_cell_may_be_in_pieces():
    found = Tessellation([[3, 0.5], [0.75, 3.5]], HOOK)
    lower, upper = found.cells
    assert lower.area + upper.area == pytest.approx(shapely.Polygon(HOOK).area)
    points = np.array([[3.5, 1.0], [0.75, 3.25]])  # the first one's cell: both ends of the hook
    apart = Tessellation(points, HOOK).cells[0]
    assert shapely.get_num_geometries(apart) == 2
    assert shapely.contains_xy(apart, [3.8, 3.8], [1.0, 2.6]).all()


def test_edges_halve_the_way_between_their_points():
    points = np.random.default_rng(5).uniform(0, 4, (2, 12))
    found = Tessellation(points, HOOK)
    beside = [(i, j) for i in range(12) for j in found.neighbours(i)]
    assert len(beside) > 20
    for i, j in beside:
        assert i in found.neighbours(j)
        assert found.edge(i, j) == found.edge(j, i)
        for end in found.edge(i, j):
            assert np.hypot(*(end - points[:, i])) == pytest.approx(
                np.hypot(*(end - points[:, j])), abs=1e-9
            )
            assert shapely.distance(shapely.Polygon(HOOK), shapely.Point(end)) < 1e-9


coordinate = st.floats(-0.5, 4.5).map(lambda value: round(value, 3))
teams = st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=8)


@settings(max_examples=20, deadline=None)
@given(team=teams, region=st.sampled_from(sorted(REGIONS)))
def test_whatever_the_team_its_cells_share_out_the_region(team, region):
    points, outline = np.array(team).T, REGIONS[region]
    found, whole = Tessellation(points, outline), shapely.Polygon(outline)
    assert found.areas.sum() == pytest.approx(whole.area, rel=1e-9)
    assert shapely.area(shapely.union_all(found.cells)) == pytest.approx(whole.area, rel=1e-9)
    for i, cell in enumerate(found.cells):
        assert shapely.area(cell) == pytest.approx(found.areas[i], abs=1e-9)
        if cell.is_empty:
            continue
        corners = shapely.get_coordinates(cell).T
        apart = np.hypot(*(corners[:, :, None] - points[:, None]))
        assert (apart[:, i] <= apart.min(axis=1) + 1e-7).all()
        if cell.geom_type == "Polygon" and cell.convex_hull.area - cell.area < 1e-12:
            centroid = shapely.Point(found.centroids[:, i])
            assert shapely.distance(cell, centroid) < 1e-6
    beside = {(i, j) for i in range(len(team)) for j in found.neighbours(i)}
    assert beside == {(j, i) for i, j in beside}


@settings(max_examples=10, deadline=None)
@given(
    start=st.tuples(coordinate, coordinate),
    apart=st.floats(1e-7, 1e-2),
    angle=st.floats(0, 6.3),
    region=st.sampled_from(sorted(REGIONS)),
)
def test_points_that_nearly_touch_are_told_apart(start, apart, angle, region):
    x, y = start
    points = np.array([[x, x + apart * cos(angle), 2.0], [y, y + apart * sin(angle), 2.01]])
    found, whole = Tessellation(points, REGIONS[region]), shapely.Polygon(REGIONS[region])
    assert found.areas.sum() == pytest.approx(whole.area, rel=1e-9)
    mass, _, _ = sampled(points, REGIONS[region])
    assert found.areas == pytest.approx(mass, abs=0.2)


@each_case("phi", [None, bump])
@each_case("region", REGIONS)
def test_the_gradient_of_the_cost_is_twice_mass_times_way_from_the_centroid(region, phi):
    points = np.random.default_rng(11).uniform(0.3, 3.7, (2, 6))
    found = Tessellation(points, REGIONS[region], phi, resolution=0.1)
    wanted = 2 * found.masses * (points - found.centroids)
    assert found.gradient == pytest.approx(wanted)
    for i in range(6):
        for axis in (0, 1):
            step = np.zeros_like(points)
            step[axis, i] = 1e-4
            above, below = (
                Tessellation(points + way * step, REGIONS[region], phi, resolution=0.1).cost
                for way in (1, -1)
            )
            measured = (above - below) / 2e-4
            assert measured == pytest.approx(wanted[axis, i], abs=2e-5)


def test_a_constant_density_is_as_none_but_for_its_factor():
    points = np.random.default_rng(1).uniform(0, 4, (2, 7))
    plain, tripled = Tessellation(points, HOOK), Tessellation(points, HOOK, lambda x, y: 3.0)
    assert tripled.masses == pytest.approx(3 * plain.areas, rel=1e-12)
    assert tripled.areas == pytest.approx(plain.areas, rel=1e-12)
    assert tripled.centroids == pytest.approx(plain.centroids, rel=1e-12)
    assert tripled.cost == pytest.approx(3 * plain.cost, rel=1e-12)


def test_polynomials_are_integrated_exactly():
    found = Tessellation([[0.5], [0.7]], HOOK, lambda x, y: x * x * y)
    boxes = [(0, 4, 0, 1.5), (0, 1.5, 1.5, 2.5), (0, 4, 2.5, 4)]
    mass = sum((b**3 - a**3) / 3 * (d**2 - c**2) / 2 for a, b, c, d in boxes)
    first = sum((b**4 - a**4) / 4 * (d**2 - c**2) / 2 for a, b, c, d in boxes)
    assert found.masses == pytest.approx([mass], rel=1e-12)
    assert found.centroids[0] == pytest.approx([first / mass], rel=1e-12)


@each_case(
    ("points", "region", "message"),
    [
        ([], SQUARE, r"Tessellation.points = \[\]: expected points \(2, n\) in metres"),
        ([(1, 2, 3), (1, 2, 3), (0, 0, 0)], SQUARE, "Tessellation.points = .*: expected points"),
        ([[1, np.nan], [1, 2]], SQUARE, "Tessellation.points = .*: expected points.*finite"),
        ("here", SQUARE, "Tessellation.points = 'here': expected points"),
        ([[1], [1]], [(0, 0), (1, 1)], r"^Tessellation\.region"),
        ([[1], [1]], [(0, 0), (1, 1), (0, 1), (1, 0)], r"^Tessellation\.region"),
        ([[1], [1]], None, r"^Tessellation\.region"),
    ],
)
def test_what_can_not_be_is_an_error(points, region, message):
    with pytest.raises(InputError, match=message):
        Tessellation(points, region)
