"""Figures show what the record holds, are reproducible, and leave matplotlib's state alone."""

from __future__ import annotations

import dataclasses
import pickle
import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex, to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon

import mars2d
from mars2d import Animation, InputError, Record, Robot, Scenario
from mars2d.addons import Map
from mars2d.bodies.colors import NEUTRAL
from mars2d.bodies.joints import Rope
from mars2d.bodies.props import Box, Puck
from mars2d.core.scene import Scene
from mars2d.output.figures.artists import paint
from mars2d.output.figures.figure import plot_paths, plot_snapshots, save_figure
from mars2d.output.layers.forces import FORCE
from mars2d.output.layers.table import Layers
from mars2d.sensors import Proximity
from tests.cases import each_case
from tests.processes import PATIENCE

CHEVRON = [(2.0, 2.0), (4.0, 4.0), (2.0, 3.0), (0.0, 4.0)]


def law(robot):
    return 0.3, 0.2 * np.cos(robot.time)


def team(**changes):
    settings = {
        "title": "Two go round",
        "robots": [
            Robot(pose=(-3, -3, 0), name="Ada", controller=law),
            Robot(pose=(-3, 1, 0.5), name="Bob", controller=law, diameter=0.6),
        ],
        "sampling_time": 0.1,
        "stop_time": 8.0,
        "addons": [Map([CHEVRON, [(-4, 4), (-1, 4)]])],
    }
    return Scenario(**(settings | changes))


@pytest.fixture(scope="module")
def record() -> Record:
    return mars2d.run(team())


def trails(ax):
    return [line for line in ax.lines if len(line.get_xdata()) > 2]


def discs(ax):
    return [patch for patch in ax.patches if isinstance(patch, Circle)]


def hollow(artist):
    return to_rgba(artist.get_facecolor())[3] == 0


def pixel(ax, point):
    """Return the colour painted at a point in metres."""
    canvas = FigureCanvasAgg(ax.figure)
    canvas.draw()
    image = np.asarray(canvas.buffer_rgba())[:, :, :3]
    x, y = ax.transData.transform(point)
    return to_hex(image[image.shape[0] - 1 - int(y), int(x)] / 255)


# -- the paths --------------------------------------------------------------------------------


def test_the_paths_are_the_poses_of_the_record(record):
    lines = trails(record.plot())
    assert len(lines) == 2
    for i, (line, color) in enumerate(zip(lines, record.scenario.colors, strict=True)):
        np.testing.assert_array_equal(line.get_xydata(), record.pose[:, :2, i])
        assert to_hex(line.get_color()) == color


def test_initial_poses_are_hollow_and_final_poses_filled_and_to_scale(record):
    initial, final = discs(record.plot())[:2], discs(record.plot())[2:]
    for i, robot in enumerate(record.scenario.robots):
        assert hollow(initial[i])
        assert to_hex(initial[i].get_edgecolor()) == record.scenario.colors[i]
        assert to_hex(final[i].get_facecolor()) == record.scenario.colors[i]
        assert initial[i].get_radius() == final[i].get_radius() == robot.diameter / 2
        np.testing.assert_allclose(initial[i].center, record.pose[0, :2, i])
        np.testing.assert_allclose(final[i].center, record.pose[-1, :2, i])


def test_axes_are_equal_labelled_and_titled(record):
    ax = record.plot()
    assert ax.get_aspect() == 1
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "y [m]")
    assert ax.get_title() == "Two go round, t = 8 s"
    ax.figure.canvas.draw()
    across, up = ax.transData.transform((1, 0)), ax.transData.transform((0, 1))
    origin = ax.transData.transform((0, 0))
    assert (across - origin)[0] == pytest.approx((up - origin)[1], rel=1e-6)
    np.testing.assert_allclose(np.diff(ax.get_xticks())[0], np.diff(ax.get_yticks())[0])


def test_titles_and_names_are_shown_as_they_are_written():
    robots = [Robot(name=r"_a $\nor$ b")]
    scenario = Scenario(title=r"From $\nonsense$ to 5", robots=robots, stop_time=1)
    ax = mars2d.run(scenario, control=lambda world: [[0.1], [0.0]]).plot()
    assert ax.get_title() == r"From $\nonsense$ to 5, t = 1 s"
    assert [text.get_text() for text in ax.get_legend().get_texts()] == [r"_a $\nor$ b"]
    ax.figure.canvas.draw()  # raises where it is taken for mathematics


def test_the_legend_names_few_robots_beside_the_drawing(record):
    ax = record.plot()
    legend = ax.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["Ada", "Bob"]
    assert [to_hex(h.get_color()) for h in legend.legend_handles] == list(record.scenario.colors)
    ax.figure.canvas.draw()
    assert legend.get_window_extent().x0 >= ax.get_window_extent().x1
    assert legend.get_window_extent().x1 <= ax.figure.bbox.x1


# -- what the animation's fields choose -------------------------------------------------------


def record_with(record, **changes):
    scenario = record.scenario.replace(animation=Animation(**changes))
    return dataclasses.replace(record, scenario=scenario)


def styled(record, **changes):
    return record_with(record, **changes).plot()


def test_a_figure_of_paths_has_them_unless_they_are_switched_off(record):
    assert len(trails(styled(record, wake=False))) == len(record.scenario.robots)
    still = record_with(record, wake=False)
    (now,) = plot_snapshots(still, [still.time[-1]]).axes
    assert trails(now) == []
    assert trails(plot_paths(still, layers=Layers(trails=False))) == []


def test_what_sensors_read_is_faint_and_left_out_in_a_crowd() -> None:
    def areas(count: int) -> list[float]:
        near = [Robot(pose=(0.4 * k, 0, 0), sensors=[Proximity(range=0.9)]) for k in range(count)]
        circles = discs(plot_paths(mars2d.run(Scenario(robots=near, stop_time=1))))
        return [patch.get_facecolor()[3] for patch in circles if patch.radius == 0.9]

    assert areas(2) == pytest.approx([0.1, 0.1], abs=0.01)  # 0.22 in the window
    assert areas(9) == []


@each_case("style, marker, line", [("o--", "o", "--"), (".", "o", "None"), ("x-.", "x", "-.")])
def test_wake_styles_are_matlabs(record, style, marker, line):
    trail = trails(styled(record, wake_style=style))[0]
    assert (str(trail.get_marker()), trail.get_linestyle()) == (marker, line)
    np.testing.assert_array_equal(trail.get_xydata(), record.pose[:, :2, 0])


# -- what is in view --------------------------------------------------------------------------


def limits(ax):
    (xmin, xmax), (ymin, ymax) = ax.get_xlim(), ax.get_ylim()
    return xmin, xmax, ymin, ymax


def test_a_path_that_leaves_the_workspace_stays_in_view():
    scenario = Scenario(robots=[Robot()], on_exit="ignore", stop_time=100)
    run = mars2d.run(scenario, control=lambda world: [[0.2], [0.0]])
    xmin, xmax, ymin, ymax = limits(run.plot())
    assert 20.15 < xmax < 22
    assert max(xmin, ymin, -ymax) < -5


# -- axes and figures of one's own ------------------------------------------------------------


def test_a_second_record_on_given_axes_keeps_the_first_in_view(record):
    other, ax = Figure().subplots(1, 2)
    far = Scenario(robots=[Robot(pose=(20, 0, 0))], workspace=None, stop_time=1)
    assert mars2d.run(far, control=lambda world: [[0.1], [0.0]]).plot(ax) is ax
    record.plot(ax)
    xmin, xmax, *_ = limits(ax)
    assert xmin < -5
    assert xmax > 20
    assert not other.has_data()


def test_a_notebook_shows_the_axes_and_their_figure(record):
    ax = record.plot()
    for shown in (ax, ax.figure, pickle.loads(pickle.dumps(ax)), plot_snapshots(record, [1])):
        assert shown._repr_png_().startswith(b"\x89PNG")


@pytest.mark.slow
def test_neither_windows_nor_pyplot_are_touched(tmp_path):
    code = """
import sys, mars2d
assert "matplotlib" not in sys.modules
import mars2d.output.figures.figure as figure
assert "matplotlib" not in sys.modules
run = mars2d.run("random_walk", stop_time=20)
run.plot()._repr_png_()
figure.plot_snapshots(run, [0, 20])
import matplotlib
names = set(matplotlib.rcParams) - {"backend"}  # to look at that one imports pyplot
before = {name: matplotlib.rcParams[name] for name in names}
figure.save_figure(run, sys.argv[1])
assert {name: matplotlib.rcParams[name] for name in names} == before
for module in ("matplotlib.pyplot", "pygame", "pymunk.pygame_util", "tkinter"):
    assert module not in sys.modules, module
"""
    path = str(tmp_path / "walk.png")
    subprocess.run(
        [sys.executable, "-W", "error::UserWarning", "-c", code, path], check=True, timeout=PATIENCE
    )


# -- snapshots --------------------------------------------------------------------------------


def test_snapshots_show_the_paths_until_each_time(record):
    figure = plot_snapshots(record, [0.3, 4.04, 8])
    assert [ax.get_title() for ax in figure.axes] == ["t = 0.3 s", "t = 4 s", "t = 8 s"]
    for ax, row in zip(figure.axes, (3, 40, 80), strict=True):
        assert record.time[row] == pytest.approx(float(ax.get_title()[4:-2]))
        np.testing.assert_array_equal(trails(ax)[1].get_xydata(), record.pose[: row + 1, :2, 1])
        np.testing.assert_allclose(discs(ax)[-1].center, record.pose[row, :2, 1])
        assert ax.get_aspect() == 1
    assert len({limits(ax) for ax in figure.axes}) == 1
    assert [ax.get_legend() is not None for ax in figure.axes] == [False, False, True]


@each_case("count, cols", [(1, 1), (2, 2), (3, 3), (4, 2), (5, 3), (6, 3), (8, 4), (9, 3), (12, 4)])
def test_snapshots_are_in_so_many_columns_that_each_can_be_read(record, count, cols):
    figure = plot_snapshots(record, np.arange(count) / 10)
    assert len({ax.get_position().x0 for ax in figure.axes}) == cols


@each_case("time, named", [(8.1, "8.1 s"), (-1, "-1 s"), (np.nan, "nan s")])
def test_a_time_outside_of_the_record_is_refused(record, time, named):
    with pytest.raises(InputError, match=rf"{named} is outside of the record.* 0 to 8 s"):
        plot_snapshots(record, [1.0, time])


# -- files ------------------------------------------------------------------------------------


@pytest.mark.slow
@each_case("suffix, start", [(".png", b"\x89PNG"), (".pdf", b"%PDF"), (".svg", b"<?xml")])
def test_files_have_their_format_and_are_reproducible(record, tmp_path, suffix, start):
    first, second = tmp_path / f"a{suffix}", tmp_path / f"b{suffix}"
    assert save_figure(record, first) == first
    save_figure(record, str(second))
    assert first.read_bytes().startswith(start)
    assert first.read_bytes() == second.read_bytes()
    for dated in (b"CreationDate", b"dc:date"):
        assert dated not in first.read_bytes()


@each_case("name", ["a.jpg", "a", "a.svgz"])
def test_an_unknown_suffix_is_refused_with_the_known_ones(record, tmp_path, name):
    with pytest.raises(InputError, match=rf"{name}: .*\.png, \.pdf or \.svg"):
        save_figure(record, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


# -- paint ------------------------------------------------------------------------------------


def test_every_kind_of_shape_is_painted_with_its_opacity_and_anchor():
    scene = Scene()
    scene.polygon(CHEVRON, fill="#ff000080")
    scene.line([(0, 0), (1, 1)], stroke="#000000", width=3)
    scene.text((1, 2), "right $_", anchor="right", size=9)
    scene.circle((3, 1), 0.0, stroke="#0000ff", pixels=6)
    ax = Figure().add_subplot(xlim=(0, 4), ylim=(0, 4))
    paint(scene, ax, scale=0.5)
    (polygon,), (line, mark), (text,) = ax.patches, ax.lines, ax.texts
    np.testing.assert_array_equal(polygon.get_xy()[:-1], CHEVRON)
    assert polygon.get_alpha() is None
    assert polygon.get_facecolor()[3] == pytest.approx(0.5, abs=0.01)
    assert isinstance(line, Line2D)
    assert line.get_linewidth() == 1.5
    assert mark.get_markerfacecolor() == "none"
    assert mark.get_markersize() == 6
    assert (text.get_text(), text.get_ha(), text.get_fontsize()) == ("right $_", "right", 4.5)
    assert pixel(ax, (2.0, 2.5)) == "#ff7f7f"


# -- props, joints, forces ------------------------------------------------------------------------


def pushed(**animation):
    box = Box(pose=(-2.5, -2, 0), length=0.3, width=0.3, ground_friction=0.6, mass=1, name="box")
    far = Puck(pose=(6, 0, 0), name="far")
    robots = [Robot(pose=(-3, -2, 0), name="red"), Robot(pose=(-3, 2, 0))]
    scenario = Scenario(
        robots=robots,
        props=[box, far],
        joints=[Rope(a="red", b="far", length=12)],
        stop_time=5,
        animation=Animation(**animation),
    )
    return mars2d.run(scenario, control=lambda world: [[0.2, 0.0], [0.0, 0.0]])


def filled(ax, kind, color):
    return [
        patch
        for patch in ax.patches
        if isinstance(patch, kind) and not hollow(patch) and to_hex(patch.get_facecolor()) == color
    ]


def test_props_are_drawn_hollow_at_the_start_and_filled_at_the_end():
    record = pushed()
    ax = record.plot()
    boxes = [patch for patch in ax.patches if isinstance(patch, Polygon)]
    start = [patch for patch in boxes if hollow(patch) and len(patch.get_xy()) == 5]
    end = filled(ax, Polygon, NEUTRAL)
    assert len(end) == 1
    assert any(np.allclose(p.get_xy().mean(axis=0), (-2.53, -2.03), atol=0.1) for p in start)
    np.testing.assert_allclose(end[0].get_xy()[:4].mean(axis=0), record.prop_pose[-1, :2, 0])
    assert len(filled(ax, Circle, NEUTRAL)) == 1


def test_forces_are_drawn_when_the_animation_says_so():
    assert not filled(pushed().plot(), Polygon, FORCE)
    ax = pushed(forces=True).plot()
    arrows = {tuple(np.round(p.get_xy()[:7].ravel(), 6)) for p in filled(ax, Polygon, FORCE)}
    assert len(arrows) == 2, "of the pair"
    assert ax.texts[0].get_text() == "5.0 N"


def test_heights_of_text_follow_the_settings_of_matplotlib(record):
    with mpl.rc_context({"font.size": 8, "font.family": "STIXGeneral"}):
        figures = [record.plot().figure, record.plot_signals("x")[0].figure]
    for figure in figures:
        figure.canvas.draw()
        texts = [t for t in figure.findobj(mpl.text.Text) if t.get_text()]
        assert {round(t.get_fontsize(), 1) for t in texts} <= {9.6, 8.0, 7.2}
