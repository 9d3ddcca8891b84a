"""Names, links and ranges in figures, each only where it is asked for."""

import numpy as np
import pytest

import mars2d
from mars2d import Animation, InputError, Robot, Scenario, Within
from mars2d.addons import Communication
from mars2d.cli.command_line import main
from mars2d.core.scene import Circle
from mars2d.output.figures.figure import plot_paths
from mars2d.output.layers.neighbours import place_range, range_of
from mars2d.output.layers.table import Layers, of_bodies
from tests.cases import each_case


def crowd(n, seed=0, **fields):
    """Return a record of robots that stand close to each other."""
    rng = np.random.default_rng(seed)
    side = int(np.ceil(np.sqrt(n)))
    robots = [
        Robot(pose=(0.4 * (k % side), 0.4 * (k // side), rng.uniform(-3, 3))) for k in range(n)
    ]
    return mars2d.run(Scenario(robots=robots, stop_time=0.1, **fields))


def labels(figure):
    """Return the names in a figure: their texts and boxes in pixels."""
    figure.canvas.draw()
    (ax,) = figure.axes
    return {
        text.get_text(): text.get_window_extent()
        for text in ax.texts
        if text.get_text() and not text.get_text().startswith("t =")
    }


@each_case(
    "fields, reach",
    [
        ({"addons": [Communication(range=1.5)]}, 1.5),
        ({"neighbours": Within(0.7)}, 0.7),
        ({"addons": [Communication(range=1.5)], "neighbours": Within(0.7)}, 1.5),
        ({"addons": [Communication()], "neighbours": Within(0.7)}, 0.7),
        ({"addons": [Communication()]}, None),
        ({}, None),
    ],
)
def test_a_range_is_the_radios_or_that_of_neighbours(fields, reach):
    record = crowd(3, **fields)
    assert range_of(record.scenario) == reach
    circles = of_bodies(place_range)(record.frame(-1)).shapes
    assert [c.radius for c in circles if isinstance(c, Circle)] == [reach] * (3 if reach else 0)


def test_an_animation_switches_them_on():
    made = Scenario(
        robots=[Robot(pose=(k, 0, 0)) for k in range(3)], neighbours=Within(1.2), stop_time=0.1,
        animation=Animation(names=True, neighbours=True, ranges=True),
    )  # fmt: skip
    layers = Layers.of(made.animation)
    asked = {"names", "neighbours", "ranges"}
    assert asked <= layers.on
    assert not asked & Layers.of(Animation()).on
    ax = plot_paths(mars2d.run(made))
    assert len(labels(ax.figure)) == 3
    assert sum(patch.get_gid() is None for patch in ax.patches) > 3


# -- the legend -----------------------------------------------------------------------------------


def legend(record, **options):
    found = plot_paths(record, **options).get_legend()
    return [] if found is None else [text.get_text() for text in found.get_texts()]


def test_robots_that_look_alike_have_one_entry():
    robots = [Robot(name=f"red{k}", color="red", pose=(k, 0, 0)) for k in range(3)]
    robots += [Robot(name=f"blue{k}", color="blue", pose=(k, 1, 0)) for k in range(2)]
    record = mars2d.run(Scenario(robots=[*robots, Robot(name="me", pose=(0, 3, 0))], stop_time=0.1))
    assert legend(record) == ["red0 and 2 alike", "blue0, blue1", "me"]


# -- times and files ------------------------------------------------------------------------------


def titles(figure):
    return [ax.get_title() for ax in figure.axes]


def test_the_end_is_a_time():
    record = mars2d.run("random_walk", stop_time=10)
    assert titles(record.plot_snapshots([0, 5, "end"])) == ["t = 0 s", "t = 5 s", "t = 10 s"]
    with pytest.raises(InputError, match=r"times = \[0, 'last'\]: expected times in seconds"):
        record.plot_snapshots([0, "last"])


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_run_says_which_files_it_wrote(here, capsys):
    words = ["run", "random_walk", "--headless", "--stop-time", "5", "--record", "a.npz"]
    assert main([*words, "--figure", "a.png", "--at", "0,end", "--html", "a.html"]) == 0
    told = capsys.readouterr().out
    assert told.endswith("record: a.npz\nfigure: a.png\npage:   a.html\n")
    assert main([*words, "--json"]) == 0
    assert capsys.readouterr().out.count("\n") == 1


def test_a_snapshot_after_an_early_end_is_of_the_end(here, capsys):
    (here / "short.py").write_text(
        "from mars2d import Robot, Scenario\n"
        "def go(robot):\n"
        "    if robot.time > 0.95: robot.world.stop('enough')\n"
        "    return 0.1, 0\n"
        "scenario = Scenario(robots=[Robot(controller=go)], stop_time=60)\n"
    )
    assert main(["run", "short.py", "--headless", "--figure", "a.svg", "--at", "0,20,60"]) == 0
    assert "figure: a.svg" in capsys.readouterr().out
    assert (here / "a.svg").read_text().count("t = 1 s") == 1


@each_case("kind", ["paths", "snapshots"])
def test_layers_of_a_plot_are_switched_by_name(here, capsys, kind):
    crowd(4, neighbours=Within(0.45)).save("a.npz")
    at = ["--at", "end"] if kind == "snapshots" else []
    words = ["plot", "a.npz", kind, *at, "--layers", "names,neighbours,ranges,no-grid"]
    assert main([*words, "--figure", "a.png"]) == 0
    assert main(["plot", "a.npz", kind, *at, "--layers", "nams", "--figure", "a.png"]) == 2
    assert "--layers nams: there is no such layer; did you mean 'names'?" in capsys.readouterr().err
