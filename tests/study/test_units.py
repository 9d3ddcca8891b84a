"""Units: which are known, how others are stated, where they are shown."""

from __future__ import annotations

import re

import pytest

from mars2d import InputError
from mars2d.study.summary import comparison, summary
from mars2d.study.table import Result, Table
from mars2d.study.units import checked_units, parse_units, unit_of_field
from tests.cases import each_case


def study(setting, units=None):
    """Return a table of a setting with two values and two seeds, and of two measures."""
    results = [
        Result(k + 1, {setting: (1, 2)[k // 2]}, k % 2, {"end_time": 3.0 * k, "far": k})
        for k in range(4)
    ]
    return Table("a.py", (setting,), ("end_time", "far"), tuple(results), units or {})


@each_case(
    "setting, unit",
    [
        ("stop_time", "s"),
        ("animation.speed", ""),
        ("robots.0.diameter", "m"),
        ("robots.*.pose", "m, m, rad"),
        ("robots.*.drive.max_linear_speed", "m/s"),
        ("robots.0.sensors.1.range", "m"),
        ("neighbours.range", "m"),
        ("joints.0.stiffness", ""),  # N/m or N m/rad
        ("gain", ""),
        ("nothing.known.here", ""),
    ],
)
def test_a_setting_has_the_unit_of_its_field(setting, unit):
    assert unit_of_field(setting) == unit


def test_tables_and_their_heads_show_units():
    table = study("stop_time", {"far": "m"})
    text = summary(table)
    assert "stop_time [s]  runs  end_time [s]" in text
    assert "far [m]" in text
    assert "differences from stop_time = 1 s, seed by seed" in comparison(table, "stop_time")
    assert "<th>stop_time [s]</th><th>seed</th><th>end_time [s]</th>" in table._repr_html_()


def test_a_unit_that_is_stated_is_kept_in_the_file_and_no_other(tmp_path):
    path = tmp_path / "r.csv"
    table = study("stop_time", {"far": "1/s"})
    table.save(path)
    assert path.read_text().startswith("row,experiment,stop_time,seed,end_time,far [1/s],digest,")
    assert Table.load(path) == table


@each_case(
    "texts, said",
    [
        (["far"], "--unit far: expected NAME=UNIT, such as --unit spread=m"),
        (["far="], "expected NAME=UNIT"),
        (["far=m", "far=s"], "--unit far: is given twice"),
        (["fer=m"], "unit of 'fer': there is no such setting or measure; did you mean 'far'?"),
        (["far=m]"], "unit of 'far' = 'm]': expected at most 20 letters"),
    ],
)
def test_a_unit_that_can_not_be_is_said(texts, said):
    with pytest.raises(InputError, match=re.escape(said)):
        checked_units(parse_units(texts), ["far", "gain"])
