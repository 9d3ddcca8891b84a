"""The figure of a study: what its axes, lines and dots show is what the table holds."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from mars2d import InputError
from mars2d.study.figure import plot_study, save_study_figure
from mars2d.study.statistics import interval, proportion, shared
from mars2d.study.table import Result, Table


def study(settings, value, seeds=6, measures=("error",)):
    """A table over a grid; value(*point, seed) is the measure, or a tuple of them."""
    names, grid = list(settings), [()]
    for values in settings.values():
        grid = [(*point, v) for point in grid for v in values]
    results = []
    for point in grid:
        for seed in range(seeds):
            found = value(*point, seed)
            found = found if isinstance(found, tuple) else (found,)
            options, told = (
                dict(zip(names, point, strict=True)),
                dict(zip(measures, found, strict=True)),
            )
            results.append(Result(len(results) + 1, options, seed, told))
    return Table("hunt.py", tuple(names), tuple(measures), tuple(results))


def bars(ax):
    """The ends (k, 2) of all intervals in a panel."""
    return np.array(
        [
            sorted(segment[:, 1])
            for collection in ax.collections
            if isinstance(collection, LineCollection)
            for segment in collection.get_segments()
        ]
    )


def markers(ax, hollow=None):
    """The values of the means in a panel; hollow: only those that are, or are not."""
    lines = [line for line in ax.lines if line.get_zorder() == 3.2]
    if hollow is not None:
        lines = [line for line in lines if (line.get_markerfacecolor() == "white") == hollow]
    return [float(line.get_ydata()[0]) for line in lines]


def dots(ax):
    return np.concatenate([line.get_ydata() for line in ax.lines if line.get_zorder() == 2.2])


def legend(axes):
    texts = axes[0].get_legend()
    return [text.get_text() for text in texts.get_texts()] if texts else []


def test_means_have_their_intervals_and_runs_are_dots():
    table = study({"gain": [0.1, 0.2, 0.3]}, lambda gain, seed: 10 * gain + 0.1 * seed)
    (ax,) = plot_study(table)
    expected = [interval([10 * g + 0.1 * s for s in range(6)]) for g in (0.1, 0.2, 0.3)]
    assert markers(ax) == pytest.approx([each.mean for each in expected])
    np.testing.assert_allclose(bars(ax), [[each.low, each.high] for each in expected])
    assert len(dots(ax)) == 18
    assert ax.get_xlabel() == "gain"
    assert "hunt.py: means with 95 % intervals" in ax.get_title(loc="left")
    assert legend([ax]) == []


def test_the_axis_is_the_first_setting_of_several_numbers_and_others_are_lines():
    settings = {"law": ["a", "b"], "n": [4], "gain": [1, 2, 3]}
    table = study(settings, lambda law, n, gain, seed: float(gain + seed))
    axes = plot_study(table)
    assert axes[0].get_xlabel() == "gain"
    assert legend(axes) == ["law = a", "law = b"]
    axes = plot_study(table, x="law")
    assert axes[0].get_xlabel() == "law"
    assert [text.get_text() for text in axes[0].get_xticklabels()] == ["a", "b"]
    assert legend(axes) == ["gain = 1", "gain = 2", "gain = 3"]


def test_a_mean_of_some_runs_is_hollow_and_their_share_has_a_panel():
    def caught(gain, seed):
        return None if gain == 2 and seed > 3 else gain + 0.1 * seed

    axes = plot_study(study({"gain": [1, 2]}, caught, measures=("capture_time",)))
    assert [ax.get_ylabel() for ax in axes] == ["capture_time\n[s]", "caught [%]"]
    assert markers(axes[0], hollow=True) == pytest.approx([2.15])
    assert markers(axes[0], hollow=False) == pytest.approx([1.25])
    assert markers(axes[1]) == pytest.approx([100, 400 / 6])
    found = proportion(4, 6)
    np.testing.assert_allclose(bars(axes[1])[1], [100 * found.low, 100 * found.high])
    assert legend(axes) == ["mean of some runs alone"]


def test_of_two_words_one_is_drawn_of_three_all():
    def words(count):
        return study({"n": [1, 2]}, lambda n, seed: "abc"[(n + seed) % count])

    assert len(plot_study(words(2))) == 1
    axes = plot_study(words(3))
    assert sorted(ax.get_ylabel() for ax in axes) == [f"error = {w}\n[%]" for w in "abc"]


def test_more_than_a_figure_can_show_is_an_error_before_anything_is_run():
    values, numbers = {"a": [1, 2], "b": [*range(9)], "c": [*range(9)]}, lambda *_: 1.0
    with pytest.raises(InputError, match=r"9 of b x 9 of c are too many lines: at most 8; draw"):
        plot_study(study(values, numbers, seeds=1))
    with pytest.raises(InputError, match="no such setting; did you mean 'gain'"):
        plot_study(study({"gain": [1, 2]}, numbers), x="gian")


def test_it_draws_on_axes_that_are_given():
    table = study({"n": [1, 2]}, lambda n, seed: (1.0 * seed, "ab"[seed % 2]), measures=("m", "w"))
    given = Figure().subplots(2)
    assert plot_study(table, given) == list(given)
    with pytest.raises(
        InputError, match=r"axes: 1 of them, for 2 panels \(m, w = a\): one for each"
    ):
        plot_study(table, [given[0]])
    with pytest.raises(InputError, match="expected plain axes"):
        plot_study(table, ["ax", "ay"])


def test_a_share_is_drawn_in_percent_from_0_to_100_with_its_interval():
    table = study({"gain": [1, 2]}, lambda gain, seed: seed < 3 * gain)
    (ax,) = plot_study(table)
    assert ax.get_ylabel() == "error = 1\n[%]"
    assert ax.get_yticks().tolist() == [0, 25, 50, 75, 100]
    assert ax.get_ylim() == (-6, 106)
    assert markers(ax) == [50, 100]
    half = shared(np.array([1.0, 1, 1, 0, 0, 0]))
    assert bars(ax)[0] == pytest.approx((100 * half.low, 100 * half.high))
    assert ax.get_title(loc="left") == "hunt.py: shares with 95 % intervals"


def test_the_same_table_gives_the_same_file(tmp_path):
    table = study({"gain": [1, 2], "law": ["a", "b"]}, lambda gain, law, seed: float(gain + seed))
    first, second = (save_study_figure(table, tmp_path / f"{k}.svg") for k in range(2))
    assert first.read_bytes() == second.read_bytes()
    assert save_study_figure(table, tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(InputError, match="a figure is saved as"):
        save_study_figure(table, tmp_path / "a.jpeg")
