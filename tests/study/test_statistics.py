"""Statistics hold against printed tables, against worked examples, and against chance itself."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

from mars2d.study.statistics import (
    interval,
    paired,
    paired_shares,
    proportion,
    seeds_for_share,
    seeds_needed,
    shared,
)
from tests.cases import each_case

STUDIES = 2000


@each_case(
    "n, confidence, t",
    [(2, 0.95, 12.706), (5, 0.95, 2.776), (10, 0.99, 3.250), (31, 0.90, 1.697), (121, 0.95, 1.980)],
)
def test_the_interval_of_a_mean_has_the_quantiles_of_the_printed_tables(n, confidence, t):
    values = np.random.default_rng(n).normal(size=n)
    found = interval(values, confidence)
    assert found.half_width / (values.std(ddof=1) / math.sqrt(n)) == pytest.approx(t, abs=6e-4)
    assert found.mean == pytest.approx(values.mean())
    assert found.count == n


def test_student_s_own_example_of_sleep():
    # Additional hours of sleep by two drugs (Student 1908, table I).
    first = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0]
    second = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4]
    found = paired(second, first)
    assert found.mean == pytest.approx(1.58)
    assert (found.low, found.high) == pytest.approx((0.7001, 2.4599), abs=1e-4)


def test_wilson_s_interval_has_its_published_values():
    found = proportion(81, 263)  # Newcombe (1998), table I, method 3
    assert (found.low, found.high) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    found = proportion(0, 20)
    assert (found.low, found.high) == pytest.approx((0.0, 0.1611), abs=5e-5)
    found = proportion(29, 29)
    assert (found.low, found.high) == pytest.approx((0.8830, 1.0), abs=5e-5)


def test_paired_shares_cover_their_difference():
    rng = np.random.default_rng(3)
    luck = rng.random((STUDIES, 40))
    a, b = (luck < 0.7).astype(float), (luck < 0.5).astype(float)
    found = [paired_shares(x, y) for x, y in zip(a, b, strict=True)]
    covered = sum(each.low <= 0.2 <= each.high for each in found) / STUDIES
    assert 0.92 <= covered <= 0.985  # an approximation for few runs


def test_shares_that_are_all_the_same_leave_room():
    found = paired_shares([1.0] * 10, [1.0] * 10)
    assert found.mean == 0
    assert found.low == pytest.approx(-found.high)
    assert found.high > 0.1
    assert shared([1, 1, math.nan, 0]).count == 3


def test_what_was_not_measured_is_left_out_and_counted():
    found = interval([1.0, math.nan, 2.0, math.inf, 3.0])
    assert (found.mean, found.count) == (2.0, 3)
    found = paired([1.0, math.nan, 3.0, 5.0, math.inf], [0.0, 1.0, math.nan, 4.0, math.inf])
    assert (found.mean, found.count) == (1.0, 2)
    assert paired_shares([math.nan], [1.0]).count == 0


def test_the_seeds_needed_are_the_fewest_whose_interval_is_narrow_enough():
    values = np.random.default_rng(4).normal(10.0, 2.0, 30)
    for half_width in (5.0, 1.0, 0.3, 0.1):
        n = seeds_needed(values, half_width)

        def half(runs):
            return stats.t.ppf(0.975, runs - 1) * values.std(ddof=1) / math.sqrt(runs)

        assert half(n + 1) <= half_width
        assert n == 2 or half(n - 1) > half_width
    assert seeds_needed([1.0, 1.0, 1.0], 0.1) == 2
    assert seeds_needed([1.0], 0.1) is None
    assert seeds_needed([0.0, 1.0], 1e-9) == pytest.approx(1.92e18, rel=0.01)


def test_the_seeds_for_a_share_are_the_fewest_too():
    for share in (0.0, 0.1, 0.5):
        n = seeds_for_share(share, 0.05)
        z = stats.norm.ppf(0.975)

        def half(runs, share=share, z=z):
            inside = share * (1 - share) / runs + z**2 / (4 * runs**2)
            return z / (1 + z**2 / runs) * math.sqrt(inside)

        assert half(n) <= 0.05 < half(n - 1)
