"""Summaries say what a study came to, and hide neither failures nor runs without a number."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mars2d import InputError
from mars2d.study.estimates import estimates
from mars2d.study.statistics import interval, proportion, seeds_needed
from mars2d.study.summary import comparison, differences, summary
from mars2d.study.table import Result, Table


def table_of(settings, measures, rows):
    """Rows: (options in order, seed, measures in order or the text of an error)."""
    results = []
    for number, (options, seed, values) in enumerate(rows, 1):
        failed = isinstance(values, str)
        results.append(
            Result(
                number,
                dict(zip(settings, options, strict=True)),
                seed,
                {} if failed else dict(zip(measures, values, strict=True)),
                error=values if failed else "",
            )
        )
    return Table("hunt.py", settings, measures, tuple(results))


def hunts(caught=12):
    """Two laws over 20 seeds; with the slow one only the first `caught` are caught."""
    rng = np.random.default_rng(5)
    luck, rest = 4 * rng.normal(size=20), 0.5 * rng.normal(size=(2, 20))
    rows = []
    for k, law in enumerate(("slow", "quick")):
        for seed in range(20):
            free = law == "slow" and seed >= caught
            time = None if free else 30 - 3 * k + float(luck[seed] + rest[k, seed])
            rows.append(((law, 0.5), seed, (time, "evader" if free else "pursuer")))
    return table_of(("law", "gain"), ("capture_time", "winner"), rows)


def line_of(text, start):
    """Return the first line of the first table that begins so."""
    return next(line for line in text.splitlines() if line.split()[:1] == [start])


def test_a_line_tells_mean_and_interval_of_each_point():
    table = table_of(("n",), ("error",), [((n,), s, (n + s,)) for n in (4, 8) for s in range(5)])
    text = summary(table)
    half = interval(range(5)).half_width
    assert line_of(text, "4").split() == ["4", "5", "6.0", "±", f"{half:.1f}"]
    assert line_of(text, "8").split() == ["8", "5", "10.0", "±", f"{half:.1f}"]
    assert text.startswith("10 runs of hunt.py: means and shares with their 95 % intervals")


def test_the_mean_of_those_caught_stands_beside_their_share():
    text = summary(hunts())
    found = proportion(12, 20)
    share = f"60 % [{100 * found.low:.0f}, {100 * found.high:.0f}]"
    slow = line_of(text, "slow")
    assert "(12 of 20)" in slow
    assert share in slow
    assert "(20 of 20)" in line_of(text, "quick")
    assert "capture_time is of those runs alone that have a number: k of n" in text


def test_words_are_shares_of_all_runs():
    text = summary(hunts())
    assert "winner = pursuer" in text
    assert "winner = evader" in text
    assert "40 % [22, 61]" in text


def test_truths_are_shares_and_real_numbers_of_0_and_1_are_not():
    def label(values):
        table = table_of((), ("m",), [((), k, (value,)) for k, value in enumerate(values)])
        return [estimate.label for estimate in estimates(table)]

    assert label([1, 0, 1]) == ["m = 1"]
    assert label([1.0, 0.0]) == ["m"]
    assert label([1, 2]) == ["m"]
    assert label([1, None]) == ["m = 1", "m measured"]


def test_failed_runs_are_counted_and_the_first_is_quoted():
    rows = [((n,), s, (1.0 * s,)) for n in (1, 2) for s in range(4)]
    rows[5] = ((2,), 1, "law.py, line 3: division by zero")
    text = summary(table_of(("n",), ("m",), rows))
    assert [line.split()[:3] for line in text.splitlines()[3:5]] == [
        ["1", "4", "0"],
        ["2", "4", "1"],
    ]
    assert "1 run failed and count nowhere, as row 6: law.py, line 3: division by zero" in text


def test_how_many_seeds_would_be_enough_is_that_of_the_worst_point():
    rng = np.random.default_rng(6)
    values = {1: 10 + rng.normal(size=15), 2: 10 + 4 * rng.normal(size=15)}
    rows = [((n,), s, (float(values[n][s]),)) for n in values for s in range(15)]
    text = summary(table_of(("n",), ("m",), rows))
    needed = seeds_needed(values[2], 0.05 * values[2].mean())
    assert 100 < needed < 1000
    assert f"about {math.ceil(needed / 10) * 10} seeds; n = 2 needs most" in text


# -- comparisons -----------------------------------------------------------------------------------


def test_a_comparison_is_by_pairs_of_the_same_seed():
    found = differences(hunts(caught=20), "law")[0]
    assert found.estimate.label == "capture_time"
    assert found.found.mean == pytest.approx(-3.0, abs=0.5)
    assert found.found.count == 20


def test_who_escaped_is_left_out_of_the_pairs_and_compared_by_share():
    text = comparison(hunts(), "law")
    time, share = [line for line in text.splitlines() if line.startswith("quick")][:2]
    assert "lower by" in time
    assert "12 (8 left out)" in time
    assert "higher by 40" in share
    assert "left out: pairs of which a run failed or has no number" in text


def test_several_intervals_are_wide_enough_to_hold_together():
    rows = [((k,), s, (float(s % 3 + s % 2 * k),)) for k in (1, 2, 3) for s in range(9)]
    table = table_of(("k",), ("m",), rows)
    text = comparison(table, "k")
    assert "Each of the 2 intervals is of 97.5 %: all hold together with 95 %" in text
    two = differences(table, "k")[0].found
    one = differences(table_of(("k",), ("m",), rows[:18]), "k")[0].found
    assert two.half_width > 1.1 * one.half_width
    assert "Intervals are of 95 %." in comparison(table_of(("k",), ("m",), rows[:18]), "k")


def test_runs_without_a_seed_in_common_are_no_pairs():
    rows = [((k,), 10 * k + s, (float(10 * k + s % 3),)) for k in (0, 1) for s in range(9)]
    text = comparison(table_of(("k",), ("m",), rows), "k")
    assert "too few to say" in text
    assert "0 (18 left out)" in text


def test_a_setting_that_can_t_be_compared_is_an_error():
    with pytest.raises(InputError, match="no setting 'lwa'; did you mean 'law'"):
        comparison(hunts(), "lwa")
    with pytest.raises(InputError, match="gain has one value"):
        comparison(hunts(), "gain")
    with pytest.raises(InputError, match="confidence = 95"):
        comparison(hunts(), "law", 95)
