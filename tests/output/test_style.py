"""Styles: sizes that are what they say, curves that are told apart without colours, no traces."""

from __future__ import annotations

import dataclasses
from io import BytesIO

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_hex
from PIL import Image

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.output.figures.figure import plot_snapshots, save_figure
from mars2d.output.figures.style import PRINT, PROJECTOR, STYLES, style_of
from tests.cases import each_case

KINDS = ("plot", "plot_signals", "plot_contacts", "plot_distances")


@pytest.fixture(scope="module")
def record():
    robots = [
        Robot(pose=(-1, 0, 0), name="Ada"),
        Robot(pose=(1, 0.1, np.pi), name="Bob", color="yellow"),
        *(Robot(pose=(x, 2, 0), color="blue") for x in (-2, 0, 2)),
    ]
    scenario = Scenario(title="Five", robots=robots, stop_time=6)
    return mars2d.run(scenario, control=lambda world: [[0.3] * 5, [0.1] * 5])


def drawn(record, kind, style):
    made = getattr(record, kind)(style=style)
    return (made[0] if isinstance(made, list) else made).figure


def contrast(color):
    parts = [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 1.05 / (np.dot([0.2126, 0.7152, 0.0722], linear) + 0.05)


def test_an_unknown_style_is_refused_with_the_nearest_one(record):
    for kind in KINDS:
        with pytest.raises(InputError, match=r"style = 'pint': .*did you mean 'print'"):
            getattr(record, kind)(style="pint")
    with pytest.raises(InputError, match="style = None: expected one of 'screen'"):
        style_of(None)


@each_case("kind", KINDS)
def test_in_print_text_has_eight_or_nine_points_in_a_font_that_is_embedded(record, kind):
    figure = drawn(record, kind, "print")
    figure.canvas.draw()
    texts = [t for t in figure.findobj(mpl.text.Text) if t.get_text() and t.get_visible()]
    assert len(texts) > 8
    assert {text.get_fontsize() for text in texts} <= {8, 9}
    assert {text.get_fontfamily()[0] for text in texts} == {"STIXGeneral"}
    millimetres = figure.get_size_inches()[0] * 25.4
    assert round(millimetres) in (85, 170)


def test_a_figure_for_print_is_as_wide_on_the_page_as_a_column(record, tmp_path):
    file = save_figure(record, tmp_path / "a.pdf", style="print").read_bytes()
    box = [float(n) for n in file.partition(b"/MediaBox [")[2].partition(b"]")[0].split()]
    assert box[2] * 25.4 / 72 == pytest.approx(85, abs=0.1)
    assert b"/FontFile2" in file  # TrueType, not the outlines of Type 3


def test_in_print_no_two_of_eight_robots_look_alike_without_colours():
    team = mars2d.run(Scenario(robots=8, stop_time=2), control=lambda world: [[0.3] * 8, [0] * 8])
    (ax,) = team.plot_signals("x", style="print")
    looks = {(to_hex(line.get_color()), line.get_linestyle()) for line in ax.lines}
    assert len(looks) == 8
    assert all(color[1:3] == color[3:5] == color[5:7] for color, _ in looks), "greys"
    paths = [line for line in team.plot(style="print").lines if len(line.get_xdata()) > 2]
    assert len({(line.get_color()[:7], line.get_linestyle()) for line in paths}) == 8


def test_in_print_there_is_no_title_for_the_caption_says_it(record):
    assert record.plot(style="print").get_title() == ""
    assert record.plot_signals("x", style="print")[0].get_title(loc="left") == ""
    assert record.plot_signals("x")[0].get_title(loc="left") == "Five"


@each_case("kind", KINDS)
def test_for_a_projector_a_figure_is_a_slide_with_large_text(record, kind):
    figure = drawn(record, kind, "projector")
    file = BytesIO()
    figure.savefig(file, dpi=PROJECTOR.dpi)
    assert Image.open(file).size == (1920, 1080)
    sizes = [t.get_fontsize() for t in figure.findobj(mpl.text.Text) if t.get_text()]
    assert min(sizes) >= 20
    figure.canvas.draw()
    drawn_in = figure.get_tightbbox()  # inches
    assert drawn_in.x0 >= 0
    assert drawn_in.y0 >= 0
    assert drawn_in.x1 <= figure.get_size_inches()[0]
    assert drawn_in.y1 <= figure.get_size_inches()[1]


def test_for_a_projector_pale_colours_are_darkened(record):
    assert contrast(record.scenario.colors[1]) < 2
    assert all(contrast(color) >= 3 for color in PROJECTOR.colors(record.scenario))
    assert PROJECTOR.colors(record.scenario)[0] == record.scenario.colors[0]
    (ax,) = record.plot_signals("x", style="projector")
    assert to_hex(ax.lines[1].get_color()) == PROJECTOR.colors(record.scenario)[1]


def test_robots_of_one_colour_are_told_apart_by_dashes(record):
    (ax,) = record.plot_signals("x")
    assert [line.get_linestyle() for line in ax.lines] == ["-", "-", "-", "--", ":"]


@each_case("style", STYLES)
def test_the_users_settings_of_matplotlib_are_as_they_were(record, style):
    with mpl.rc_context({"font.family": ["DejaVu Serif"], "lines.linewidth": 7}):
        before = dict(mpl.rcParams)
        drawn(record, "plot", style)
        plot_snapshots(record, [0, 3], style=style)
        assert dict(mpl.rcParams) == before


@pytest.mark.slow
@pytest.mark.parametrize("style", STYLES)
def test_the_same_record_gives_the_same_bytes_in_each_style(record, tmp_path, style):
    for suffix in ("pdf", "svg"):
        one, two = (save_figure(record, tmp_path / f"{k}.{suffix}", style=style) for k in (1, 2))
        assert one.read_bytes() == two.read_bytes()


def test_a_restyled_record_keeps_all_but_the_colours(record):
    grey = PRINT.restyled(record)
    assert grey.digest == record.digest
    assert grey.scenario.colors != record.scenario.colors
    assert grey.scenario.replace(robots=record.scenario.robots) == record.scenario
    assert dataclasses.replace(record) is not record
    assert STYLES["screen"].restyled(record) is record
