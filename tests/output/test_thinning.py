"""Long columns look the same when they are thinned: no peak and no gap is lost."""

from __future__ import annotations

import numpy as np

from mars2d.output.figures.panels import spans, thinned
from tests.cases import each_case


@each_case("count", [10_000, 10_007, 123_456])
def test_of_a_long_column_few_values_are_kept_in_order_with_both_ends(count):
    values = np.random.default_rng(1).normal(size=count)
    kept = thinned(values, 100)
    assert len(kept) <= 505
    assert (np.diff(kept) > 0).all()
    assert (kept[0], kept[-1]) == (0, count - 1)


@each_case("at", [0, 1, 4999, 7321, 9998, 9999])
@each_case("peak", [5.0, -5.0])
def test_a_single_peak_is_kept_wherever_it_is(at, peak):
    values = np.zeros(10_000)
    values[at] = peak
    assert at in thinned(values, 50)


@each_case("gap", [np.nan, np.inf, -np.inf])
def test_a_gap_of_one_value_stays_and_its_neighbours_extremes_too(gap):
    values = np.sin(np.arange(10_000) / 100)
    values[5000] = gap
    kept = thinned(values, 50)
    assert 5000 in kept
    shown = values[kept][np.isfinite(values[kept])]
    finite = values[np.isfinite(values)]
    assert (shown.min(), shown.max()) == (finite.min(), finite.max())


def test_intervals_are_joined_across_hairs_and_never_shorter_than_one():
    begin, end = spans(np.array([0.0, 1.05, 3.0, 3.2]), np.array([1.0, 1.1, 3.0, 5.0]), 0.1)
    assert begin.tolist() == [0.0, 3.0, 3.2]
    np.testing.assert_allclose(end, [1.15, 3.1, 5.0])
    assert [each.tolist() for each in spans(np.empty(0), np.empty(0), 0.1)] == [[], []]
