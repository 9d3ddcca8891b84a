"""Units: which are known, and where they are shown."""

from __future__ import annotations

from mars2d.study.summary import comparison, summary
from mars2d.study.table import Result, Table
from mars2d.study.units import unit_of_field
from tests.cases import each_case


def study(setting):
    """Return a table of a setting with two values and two seeds, and of two measures."""
    results = [
        Result(k + 1, {setting: (1, 2)[k // 2]}, k % 2, {"end_time": 3.0 * k, "far": k})
        for k in range(4)
    ]
    return Table("a.py", (setting,), ("end_time", "far"), tuple(results))


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
    table = study("stop_time")
    text = summary(table)
    assert "stop_time [s]  runs  end_time [s]" in text
    assert "differences from stop_time = 1 s, seed by seed" in comparison(table, "stop_time")
