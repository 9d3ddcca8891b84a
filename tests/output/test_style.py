"""Styles: sizes that are what they say, curves that are told apart without colours, no traces."""

from __future__ import annotations

from io import BytesIO

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_hex
from PIL import Image

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.output.figures.figure import save_figure
from mars2d.output.figures.style import PROJECTOR, style_of
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


@pytest.mark.slow
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
