"""Points, poses, polygons and lists are checked before they are kept."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from mars2d import InputError, Robot
from mars2d.core.checks import listing, outline, point, pose
from tests.cases import each_case

NAN, INF = float("nan"), float("inf")


@each_case(
    "value", [(1, 2), [1, 2.0], np.array([1, 2]), np.array([1.0, 2]), (np.float32(1), np.int8(2))]
)
def test_a_point_is_two_numbers_however_they_come(value):
    assert point("p", value) == (1.0, 2.0)
    assert all(type(v) is float for v in point("p", value))


def test_a_pose_is_a_point_with_a_heading_which_may_be_left_out():
    assert pose("p", (1, 2, 3)) == (1, 2, 3)
    assert pose("p", (1, 2)) == (1, 2, 0)
    for value in [(1,), (1, 2, 3, 4), (1, 2, NAN), (1, 2, "0"), None, "abc"]:
        with pytest.raises(InputError, match=r"a pose \(x, y, theta\)"):
            pose("p", value)


def test_a_concave_outline_keeps_its_vertices_and_their_order():
    concave = [(5, 2), (4, 3), (6, 4), (5, 3)]
    assert outline("o", concave) == tuple(concave)
    assert outline("o", concave[::-1]) == tuple(concave[::-1])


@each_case(
    ("value", "problem"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "crosses or touches itself"),
        ([(0, 0), (2, 0), (2, 2), (1, 0), (0, 2)], "crosses or touches itself"),
        ([(0, 0), (4, 0), (4, 4), (2, 0), (0, 4)], "crosses or touches itself"),
        ([(0, 0), (1, 0), (2, 0)], "lie on one line"),
        ([(0, 0), (2, 0), (1, 0), (3, 0)], "lie on one line"),
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "vertices 1 and 2 are the same"),
        ([(0, 0), (0, 0)], "vertices 0 and 1 are the same"),
        ([(0, 0), (1, 0), (1, 1e-9)], "are the same"),
        ([(0, 0)], "two vertices for a wall"),
        ([], "two vertices for a wall"),
        (None, "two vertices for a wall"),
        ("abc", "two vertices for a wall"),
        ([0, 1, 2], "a point"),
        ([(0, 0), (1, NAN), (1, 1)], r"\[1\] = nan|\[1\] = \(1, nan\)|o\[1\]"),
        ([(0, 0), (1, 0), (1, INF)], r"o\[2\]"),
        ([(0, 0), (1, 0), (1e7, 1)], r"o\[2\]"),
        ([(0, 0), (1, 0), (0.5, 0), (0.5, 1)], "crosses or touches itself"),
    ],
)
def test_an_outline_that_is_none_is_refused_with_the_reason(value, problem):
    with pytest.raises(InputError, match=problem) as raised:
        outline("o", value)
    assert str(raised.value).startswith("o")


coordinate = st.integers(-4, 4)


@given(st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=7))
def test_every_outline_that_passes_is_a_simple_polygon(vertices):
    try:
        kept = outline("o", vertices)
    except InputError:
        return
    if len(kept) > 2:
        ring = shapely.LinearRing(kept)
        assert ring.is_simple
        assert shapely.Polygon(kept).area > 0


def test_a_list_may_be_any_iterable_and_is_kept_as_a_tuple():
    check = listing(Robot, "Robot()")
    assert check("r", (Robot() for _ in range(2))) == (Robot(), Robot())
    assert check("r", []) == ()
    for value in [None, 3, "ab", [None], [Robot(), 1], {"a": Robot()}]:
        with pytest.raises(InputError, match=r"^r"):
            check("r", value)
