"""Plane geometry."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from mars2d.core import plane


@given(st.floats(-1e4, 1e4))
def test_wrapped_angles_are_the_same_angle_in_minus_pi_to_pi(angle):
    wrapped = float(plane.wrap(angle))
    assert -np.pi < wrapped <= np.pi
    turns = (angle - wrapped) / (2 * np.pi)
    assert turns == pytest.approx(round(turns), abs=1e-9)


coordinates = st.floats(-10, 10)
points = st.tuples(coordinates, coordinates)


@given(st.lists(points, min_size=3, max_size=8), st.lists(points, min_size=1, max_size=5))
def test_inside_a_polygon_is_what_shapely_says(corners, probes):
    polygon = shapely.Polygon(corners)
    assume(polygon.is_valid and polygon.area > 1e-3)
    xy = np.array(probes)
    inside = plane.inside_polygon(xy[:, 0], xy[:, 1], np.array(corners))
    for probe, answer in zip(probes, inside, strict=True):
        point = shapely.Point(probe)
        if polygon.exterior.distance(point) > 1e-9:
            assert answer == polygon.contains(point)


def test_the_inside_of_a_concave_polygon_leaves_its_notch_out():
    notched = np.array([(5, 2), (4, 3), (6, 4), (5, 3)], dtype=float)
    x, y = np.array([4.8, 5.2]), np.array([2.9, 3.0])
    assert plane.inside_polygon(x, y, notched).tolist() == [True, False]


@given(st.floats(1e-6, 1e6))
def test_a_grid_step_is_the_next_of_1_2_and_5_times_a_power_of_ten(wanted):
    steps = [k * 10.0**power for power in range(-7, 8) for k in (1, 2, 5)]
    assert plane.grid_step(wanted) == pytest.approx(
        min(step for step in steps if step >= wanted * (1 - 1e-9)), rel=1e-12
    )


segments = st.tuples(coordinates, coordinates, coordinates, coordinates)


@given(st.lists(points, min_size=1, max_size=4), st.lists(segments, min_size=1, max_size=4))
def test_the_distance_to_a_segment_is_what_shapely_says(probes, pieces):
    assume(all(np.hypot(c - a, d - b) > 1e-3 for a, b, c, d in pieces))
    x, y = np.array(probes).T[:, :, None]
    distance = plane.point_segment_distance(x, y, np.array(pieces))
    lines = [shapely.LineString([piece[:2], piece[2:]]) for piece in pieces]
    expected = [[line.distance(shapely.Point(probe)) for line in lines] for probe in probes]
    assert distance == pytest.approx(np.array(expected), abs=1e-9)


L_SHAPE = np.array([(0, 0), (4, 0), (4, 2), (2, 2), (2, 4), (0, 4)], dtype=float)


def test_the_distance_to_a_ring_counts_all_its_edges_from_both_sides():
    x, y = np.array([[5, 1], [3, 3], [1, 3.5], [-1, 2], [0.25, 1], [3, 1.75]]).T
    distances = plane.distance_to_ring(x, y, L_SHAPE)
    assert distances.tolist() == [1, 1, 0.5, 1, 0.25, 0.25]
