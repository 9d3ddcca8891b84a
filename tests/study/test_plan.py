"""Plans: settings as they are written, grids, seeds, and cells from which values come back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mars2d import InputError
from mars2d.study.plan import Plan, parse_values, settings_of
from mars2d.study.table import cell, value_in
from tests.cases import each_case


@each_case(
    "text, values",
    [
        ("0.1:1.0:10", [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]),
        ("1:10:4", [1, 4, 7, 10]),
        ("1.0:3:3", [1.0, 2.0, 3.0]),
        ("0:1:3", [0.0, 0.5, 1.0]),
        ("1:-1:3", [1, 0, -1]),
        ("1e-3:3e-3:3", [0.001, 0.002, 0.003]),
        ("4,8,16", [4, 8, 16]),
        ("a.py, b.py", ["a.py", "b.py"]),
        ("(1, 2),(3, 4)", [(1, 2), (3, 4)]),
        ("[1, 2]", [[1, 2]]),
        ("'a,b','c'", ["a,b", "c"]),
        ("0:1:2,5", [0, 1, 5]),
        ("it's,that", ["it's", "that"]),
        ("C:\\laws\\a.py", ["C:\\laws\\a.py"]),
        ("True,None", [True, None]),
        ("0.5", [0.5]),
    ],
)
def test_values_as_they_are_written(text, values):
    name, parsed = parse_values(f"gain={text}")
    assert (name, parsed) == ("gain", values)
    assert [type(value) for value in parsed] == [type(value) for value in values]


@each_case(
    "text, said",
    [
        ("gain", "expected NAME=VALUES"),
        ("gain=", "expected NAME=VALUES"),
        ("=1", "expected NAME=VALUES"),
        ("gain=1,,2", "nothing between two commas"),
        ("gain=1,", "nothing between two commas"),
        ("gain=(1,2", "all values are as in Python"),
        ("gain='a,b',c", "words in quotes"),
        ("gain=0:1:1", "a count of 2 to 1,000,000"),
        ("gain=0:1:2.5", "a count of 2 to 1,000,000"),
        ("gain=0:1:1000000000", "a count of 2 to 1,000,000"),
        ("gain=0:1e-99999999:3", "would be the same"),
        ("gain=1:1:3", "would be the same"),
        ("gain=1e999:1:3", "finite"),
    ],
)
def test_values_that_mean_nothing_are_one_line_that_says_why(text, said):
    with pytest.raises(InputError) as caught:
        parse_values(text)
    assert said in str(caught.value)
    assert text in str(caught.value)


def test_lists_ranges_and_arrays_are_several_values_and_all_else_is_one():
    settings = settings_of(
        {"a": [1, 2], "b": range(2), "c": np.array([0.5, 1.5]), "d": (1, 2), "e": "word", "f": None}
    )
    assert settings == {
        "a": (1, 2), "b": (0, 1), "c": (0.5, 1.5), "d": ((1, 2),), "e": ("word",), "f": (None,)
    }  # fmt: skip
    assert type(settings["c"][0]) is float


def test_a_plan_is_the_product_with_the_last_setting_quickest_and_seeds_inside():
    plan = Plan({"a": (1, 2), "b": ("x", "y")}, (5, 6))
    runs = [(options["a"], options["b"], seed) for options, seed in plan.runs()]
    assert runs[:4] == [(1, "x", 5), (1, "x", 6), (1, "y", 5), (1, "y", 6)]
    assert len(runs) == len(plan) == 8
    assert [*plan.probes()] == [{"a": 1, "b": "x"}, {"a": 2, "b": "x"}, {"a": 1, "b": "y"}]


plain = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(allow_nan=False, allow_infinity=False),
    st.text(st.characters(exclude_categories=["Cs"])),
)  # fmt: skip


@given(st.one_of(plain, st.tuples(plain, plain), st.lists(plain)))
def test_a_cell_gives_back_the_value_that_it_was_made_of(value):
    text = cell(value)
    back = value_in(text)
    assert back == value
    assert type(back) is type(value)
    assert len(text.splitlines()) <= 1


@given(st.decimals(-1000, 1000, places=3), st.decimals(-1000, 1000, places=3), st.integers(2, 50))
def test_evenly_spaced_values_have_both_ends_and_no_rounding_of_their_own(first, last, count):
    if first == last:
        return
    values = parse_values(f"x={first}:{last}:{count}")[1]
    assert len(values) == count
    assert (values[0], values[-1]) == (float(first), float(last))
    assert np.allclose(values, np.linspace(float(first), float(last), count))
