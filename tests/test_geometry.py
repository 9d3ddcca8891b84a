"""Plane geometry."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from mars2d import geometry


@given(st.floats(-1e4, 1e4))
def test_wrapped_angles_are_the_same_angle_in_minus_pi_to_pi(angle):
    wrapped = float(geometry.wrap(angle))
    assert -np.pi < wrapped <= np.pi
    turns = (angle - wrapped) / (2 * np.pi)
    assert turns == pytest.approx(round(turns), abs=1e-9)


def test_pi_stays_pi_and_minus_pi_becomes_it():
    assert geometry.wrap([np.pi, -np.pi]).tolist() == [np.pi, np.pi]


coordinates = st.floats(-10, 10)
points = st.tuples(coordinates, coordinates)


@given(st.lists(points, min_size=3, max_size=8), st.lists(points, min_size=1, max_size=5))
def test_inside_a_polygon_is_what_shapely_says(corners, probes):
    polygon = shapely.Polygon(corners)
    assume(polygon.is_valid and polygon.area > 1e-3)
    xy = np.array(probes)
    inside = geometry.inside_polygon(xy[:, 0], xy[:, 1], np.array(corners))
    for probe, answer in zip(probes, inside, strict=True):
        point = shapely.Point(probe)
        if polygon.exterior.distance(point) > 1e-9:
            assert answer == polygon.contains(point)


def test_the_inside_of_a_concave_polygon_leaves_its_notch_out():
    notched = np.array([(5, 2), (4, 3), (6, 4), (5, 3)], dtype=float)
    x, y = np.array([4.8, 5.2]), np.array([2.9, 3.0])
    assert geometry.inside_polygon(x, y, notched).tolist() == [True, False]


def test_bounds_are_in_the_order_of_mars():
    assert geometry.bounds_of([(1, 5), (-2, 7), (0, 6)]) == (-2, 1, 5, 7)


def test_an_outline_of_two_is_a_wall_and_of_more_a_ring():
    a, b, c = (0.0, 0.0), (1.0, 0.0), (0.0, 1.0)
    assert geometry.edges_of((a, b)) == [(a, b)]
    assert geometry.edges_of((a, b, c)) == [(a, b), (b, c), (c, a)]
