"""The figure of a study: what its axes, lines and dots show is what the table holds."""

from __future__ import annotations

import dataclasses
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from mars2d import InputError
from mars2d.study.figure import plot_study, save_study_figure
from mars2d.study.layout import layout_of
from mars2d.study.statistics import interval, proportion, shared
from mars2d.study.table import Result, Table
from tests.cases import each_case


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


def test_the_confidence_widens_the_intervals():
    table = study({"gain": [1, 2]}, lambda gain, seed: float(seed))
    (at_95,), (at_99,) = plot_study(table), plot_study(table, confidence=0.99)
    assert (np.diff(bars(at_99)) > 1.3 * np.diff(bars(at_95))).all()
    assert "99 %" in at_99.get_title(loc="left")


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


def test_numbers_that_double_are_evenly_spaced():
    (ax,) = plot_study(study({"n": [4, 8, 16, 32]}, lambda n, seed: float(n + seed)))
    assert ax.get_xscale() == "log"
    assert [text.get_text() for text in ax.get_xticklabels()] == ["4", "8", "16", "32"]
    (ax,) = plot_study(study({"n": [4, 8, 12, 16]}, lambda n, seed: float(n + seed)))
    assert ax.get_xscale() == "linear"


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


def test_too_many_lines_become_panels_side_by_side_with_one_scale():
    settings = {"n": [1, 2, 3], "gain": [1, 2, 3, 4, 5], "law": ["a", "b", "c"]}
    axes = plot_study(study(settings, lambda n, gain, law, seed: n * gain + 0.1 * seed, seeds=2))
    assert [ax.get_xlabel() for ax in axes] == [f"n\nlaw = {law}" for law in "abc"]
    assert len({ax.get_ylim() for ax in axes}) == 1


def test_more_than_a_figure_can_show_is_an_error_before_anything_is_run():
    values = range(9)
    points = [(a, b, c) for a in values for b in values for c in values]
    with pytest.raises(InputError, match=r"9 of b x 9 of c are too many lines: at most 8 in a pan"):
        layout_of(("a", "b", "c"), points)
    with pytest.raises(InputError, match="no such setting; did you mean 'gain'"):
        layout_of(("gain",), [(1,), (2,)], x="gian")


def test_one_point_and_nothing_measured_and_failures_can_be_drawn():
    (ax,) = plot_study(study({}, float, seeds=1))
    assert ax.get_xlabel() == "all runs"
    assert markers(ax) == [0.0]
    axes = plot_study(study({"n": [1, 2]}, lambda n, seed: None))
    assert [text.get_text() for text in axes[0].texts] == ["nothing was measured"]
    table = study({"n": [1, 2]}, lambda n, seed: float(seed))
    broken = Result(13, {"n": 2}, 6, {}, error="law.py, line 1: broken")
    table = Table(table.experiment, table.settings, table.measures, (*table.results, broken))
    (ax,) = plot_study(table)
    assert "1 run failed" in ax.get_title(loc="left")
    assert len(dots(ax)) == 12


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


def test_styles_change_how_it_looks():
    table = study({"gain": [1, 2], "law": ["a", "b"]}, lambda gain, law, seed: float(gain + seed))
    for style, width in (("screen", 7.0), ("print", 85 / 25.4), ("projector", 40 / 3)):
        figure = plot_study(table, style=style)[0].figure
        assert figure.get_size_inches()[0] == pytest.approx(width)
    colors = {line.get_color() for line in plot_study(table, style="print")[0].lines}
    assert colors == {"#000000"}
    with pytest.raises(InputError, match="did you mean 'print'"):
        plot_study(table, style="prnt")


LAWS = [
    "proportional_navigation.py", "pure_pursuit_with_feedforward.py", "random_walk_baseline.py",
    "laws/students/2026/group_a/pursuit.py", "constant_bearing_guidance.py",
]  # fmt: skip


def overlaps(texts):
    """Return the pairs of texts of a drawn figure that cover each other."""
    texts = [text for text in texts if text.get_text()]
    upright = [text for text in texts if not text.get_rotation()]
    assert upright == [] or upright == texts
    renderer = texts[0].figure.canvas.get_renderer()
    boxes = [text.get_window_extent(renderer) for text in texts]
    if upright:
        return [(a, b) for a, b in pairwise(boxes) if a.x1 > b.x0 and a.y1 > b.y0 and a.y0 < b.y1]
    angle = np.deg2rad(texts[0].get_rotation())
    gaps = np.diff([text.get_transform().transform(text.get_position())[0] for text in texts])
    height = texts[0].get_fontsize() * texts[0].figure.dpi / 72
    return [gap for gap in gaps if gap * np.sin(angle) < height]


@each_case("style", ["screen", "print", "projector"])
@each_case(
    "settings",
    [
        {"law": LAWS},
        {"law": [f"{k}/{law}" for k in range(4) for law in LAWS]},
        {"gain": [round(0.1 + 0.05 * k, 2) for k in range(10)]},
        {"robots.*.drive.max_linear_speed": [0.1, 0.2], "n": [1, 2, 3], "law": LAWS[:4]},
    ],
)
def test_long_names_do_not_cover_each_other(settings, style):
    figure = plot_study(study(settings, lambda *values: float(values[-1]), 2), style=style)[
        0
    ].figure
    FigureCanvasAgg(figure).draw()
    lowest = [ax for ax in figure.axes if ax.get_xlabel()]
    for ax in lowest:
        assert overlaps(ax.get_xticklabels()) == []
    assert overlaps([ax.xaxis.label for ax in lowest]) == []


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


def test_axes_and_legends_have_units():
    table = study({"stop_time": [1, 2], "robots.*.mass": [3, 4]}, lambda t, m, seed: float(seed))
    (ax,) = plot_study(dataclasses.replace(table, units={"error": "m"}))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("stop_time [s]", "error [m]")
    assert legend([ax]) == ["robots.*.mass = 3 kg", "robots.*.mass = 4 kg"]


def test_the_same_table_gives_the_same_file(tmp_path):
    table = study({"gain": [1, 2], "law": ["a", "b"]}, lambda gain, law, seed: float(gain + seed))
    first, second = (save_study_figure(table, tmp_path / f"{k}.svg") for k in range(2))
    assert first.read_bytes() == second.read_bytes()
    assert save_study_figure(table, tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(InputError, match="a figure is saved as"):
        save_study_figure(table, tmp_path / "a.jpeg")


def test_there_must_be_something_to_draw():
    with pytest.raises(InputError, match="has no runs"):
        plot_study(Table("hunt.py", ("n",), ("m",), ()))
    with pytest.raises(InputError, match="has no measures"):
        plot_study(study({"n": [1, 2]}, lambda n, seed: (), measures=()))


def test_names_are_never_read_as_formulas(tmp_path):
    table = study({"$x": [1, 2], "l_$": ["$a_", "b$"]}, lambda x, law, seed: float(seed))
    save_study_figure(table, tmp_path / "a.png")
    assert "l_$ = $a_" in legend(plot_study(table))
