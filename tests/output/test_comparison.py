"""Comparisons: the drift in numbers, and the picture."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from matplotlib.text import Text

import mars2d
from mars2d import Record, Robot, Scenario
from mars2d.output.figures.comparison import (
    COLORS,
    MODES,
    Drift,
    drifts,
    plot_comparison,
    plot_drift,
)
from mars2d.record.rows import COLUMNS


def scenario(**changes):
    robots = [Robot(pose=(-3, 2, 0), diameter=0.4), Robot(pose=(-3, -2, 0), diameter=0.4)]
    return Scenario(**({"robots": robots, "sampling_time": 0.5, "stop_time": 4.0} | changes))


def straight(speed):
    return lambda world: [[speed, speed], [0.0, 0.0]]


def run(speed, **changes):
    return mars2d.run(scenario(**changes), control=straight(speed))


def cut(record: Record, rows: int, message: str = "It ended early") -> Record:
    """Return the first rows of a record, as of a run that ended early."""
    columns = {name: getattr(record, name)[:rows] for name in COLUMNS}
    return dataclasses.replace(record, **columns, over_message=message)


def moved(record: Record, shift) -> Record:
    """Return a record whose robots are shifted by (T, 2, n) metres."""
    pose = record.pose.copy()
    pose[:, :2] += shift
    return dataclasses.replace(record, pose=pose)


def of(*records: Record) -> dict[str, Record]:
    return dict(zip(MODES, records, strict=True))


@pytest.fixture(scope="module")
def comparison():
    return of(run(0.5), run(0.25), cut(run(1.0), 5))


# -- the drift --------------------------------------------------------------------------------


def test_the_drift_is_the_distance_of_each_body_from_itself_as_long_as_both_runs_last():
    first = run(0.5)
    shift = np.zeros((len(first), 2, 2))
    shift[:, 0, 0] = 0.75 * first.time
    shift[:, 0, 1], shift[:, 1, 1] = 3.0, 4.0
    drift = Drift.between(first, cut(moved(first, shift), 5))
    np.testing.assert_array_equal(drift.time, [0.0, 0.5, 1.0, 1.5, 2.0])
    np.testing.assert_allclose(drift.max, 5.0, atol=1e-12)
    np.testing.assert_allclose(drift.mean, 2.5 + 0.375 * drift.time, atol=1e-12)
    prop = np.zeros((len(first), 3, 1))
    here = dataclasses.replace(first, prop_pose=prop)
    there = dataclasses.replace(first, prop_pose=np.add(prop, [[3.0], [4.0], [0.0]]))
    np.testing.assert_allclose(Drift.between(here, there).mean, 5 / 3)


# -- the picture ------------------------------------------------------------------------------


def texts(figure):
    return [text.get_text() for text in figure.findobj(Text) if text.get_text()]


def test_three_panels_show_the_same_part_of_the_plane_at_the_same_size(comparison):
    *panels, below = plot_comparison(comparison).axes
    assert len(panels) == 3
    assert len({(*ax.get_xlim(), *ax.get_ylim()) for ax in panels}) == 1
    places = np.array([ax.get_position().bounds for ax in panels])
    np.testing.assert_allclose(places[:, 1:], places[[0, 0, 0], 1:], atol=1e-9)
    assert (np.diff(places[:, 0]) > places[0, 2]).all()
    assert below.get_position().y1 < places[0, 1]
    assert (below.get_xlabel(), below.get_ylabel()) == ("time [s]", "drift [m]")


def test_titles_say_which_physics_how_many_collisions_and_how_it_ended(comparison):
    words = texts(plot_comparison(comparison))
    for mode in MODES:
        assert mode in words
    for what in ("collisions", "stops"):
        assert words.count(f"0 {what}, 8 steps\nfinished after 4 s") == 1
    assert "0 overlaps, 4 steps\nIt ended early" in words
    assert any(each.endswith(", seed 0") for each in words)


def test_the_curves_are_the_drift_in_the_colours_of_the_titles(comparison):
    figure = plot_comparison(comparison)
    colors = {text.get_text(): text.get_color() for text in figure.findobj(Text)}
    lines = {line.get_label(): line for line in figure.axes[-1].lines}
    assert list(lines) == ["stop, max", "stop, mean", "ideal, max", "ideal, mean"]
    for name, line in lines.items():
        mode, _, kind = name.partition(", ")
        drift = drifts(comparison)[mode]
        np.testing.assert_array_equal(line.get_xdata(), drift.time)
        np.testing.assert_array_equal(line.get_ydata(), getattr(drift, kind))
        assert line.get_color() == colors[mode] == COLORS[mode]
    assert figure.axes[-1].get_xlim() == (0, 4)


def axes():
    from matplotlib.figure import Figure

    return Figure().add_subplot()


def test_runs_that_agree_say_so():
    first, ax = run(0.5), axes()
    plot_drift(of(first, first, first), ax)
    assert [text.get_text() for text in ax.texts] == ["no drift: the three runs agree"]
    assert ax.get_ylim() == (0, 1)
