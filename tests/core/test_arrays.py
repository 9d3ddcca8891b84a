"""Arrays that can't be written, and bounds of values."""

import math
import sys

import numpy as np

from mars2d.core.arrays import sealed, within
from tests.cases import each_case


@each_case("kind", [float, bool, [("a", np.int32), ("b", float, (2,))]])
@each_case("shape", [(0,), (3,), (2, 3), (3, 0)])
def test_a_sealed_array_is_a_view_that_can_not_be_written(kind, shape):
    array = np.zeros(shape, dtype=kind)
    view = sealed(array)
    assert (view.dtype, view.shape) == (array.dtype, array.shape)
    array[...] = np.ones(shape, dtype=kind)
    assert np.array_equal(view, array)
    for each in (view, view[:1], view.view()):
        assert not each.flags.writeable


@each_case("most", [1.0, 1e6, 1e300, sys.float_info.max])
@each_case("count", [1, 2, 1000])
def test_values_are_within_a_bound_if_each_of_them_is(most, count):
    for value in (0.0, most, -most, most / 2, 1e-300):
        assert within(most, np.full((2, count), value))
    for value in (math.nextafter(most, math.inf), np.inf, -np.inf, np.nan):
        for place in (0, -1):
            values = np.zeros((2, count))
            values[place, place] = value
            assert not within(most, values)
