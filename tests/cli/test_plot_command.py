"""``mars2d plot`` draws any figure of a recorded run, and says what it was not given."""

from __future__ import annotations

from pathlib import Path

import pytest

import mars2d
from mars2d import Robot, Scenario
from mars2d.cli.command_line import main
from mars2d.cli.verbs.plot import KINDS
from tests.cases import each_case


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    robots = [Robot(pose=(-1, 0, 0), name="ann"), Robot(pose=(1, 0, 3.14), name="0")]
    scenario = Scenario(title="Two", robots=robots, stop_time=5)
    mars2d.run(scenario, control=lambda world: [[0.3, 0.3], [0, 0]]).save(folder / "duel.npz")
    return folder


@pytest.fixture
def plot(folder, tmp_path, monkeypatch, capsys):
    """Run the command in an empty folder; return its exit code, and what it says."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments, record=folder / "duel.npz"):
        code = main(["plot", str(record), *arguments])
        said = capsys.readouterr()
        return code, (said.out + said.err).strip()

    return run


@pytest.mark.slow
@each_case("kind", KINDS)
def test_each_kind_of_figure_is_drawn_and_its_file_named(plot, kind):
    extra = ["--at", "0,2"] if kind == "snapshots" else []
    assert plot(kind, *extra) == (0, f"figure: duel_{kind}.png")
    assert Path(f"duel_{kind}.png").read_bytes().startswith(b"\x89PNG")


def test_without_a_kind_the_paths_are_drawn_and_no_file_is_overwritten(plot, tmp_path):
    assert plot() == (0, "figure: duel_paths.png")
    first = (tmp_path / "duel_paths.png").read_bytes()
    assert plot("--layers", "names") == (0, "figure: duel_paths_2.png")
    assert (tmp_path / "duel_paths.png").read_bytes() == first
    assert (tmp_path / "duel_paths_2.png").read_bytes() != first


def test_columns_and_robots_are_chosen_by_name_before_index(plot, tmp_path):
    options = ["--columns", "x,command.v", "--robots", "0", "--figure", "a.svg"]
    assert plot("signals", *options)[0] == 0
    text = (tmp_path / "a.svg").read_text()
    assert "<!-- 0 -->" in text
    assert "<!-- ann -->" not in text


@each_case(
    "arguments, message",
    [
        (["signls"], "mars2d: there is no figure of 'signls'; did you mean 'signals'?"),
        (["--columns", "x"], "mars2d: --columns is for signals: mars2d plot "),
        (["contacts", "--robots", "ann"], "mars2d: --robots is for signals"),
        (["distances", "--at", "1"], "mars2d: --at is for snapshots"),
        (["paths", "--from", "1"], "mars2d: --from is for signals"),
        (["signals", "--to", "9"], "mars2d: signals from 0 to 9 s: expected a part of the run"),
        (["--headless"], "unrecognized arguments: --headless (see mars2d plot --help)"),
        (["snapshots"], "mars2d: snapshots need their times, such as --at 0,5,end"),
        (["snapshots", "--at", "9"], "mars2d: times: 9 s is outside of the record"),
        (["signals", "--columns", "efort"], "did you mean 'effort'?"),
        (["signals", "--columns", "x,"], "'x,': expected names with commas between them"),
        (
            ["signals", "--robots", "an"],
            "mars2d: robots: there is no robot 'an'; did you mean 'ann'",
        ),
        (["--figure", "a.gif"], "mars2d: --figure a.gif: expected a name that ends in .png"),
        (["--figure", "no/a.png"], "mars2d: --figure no/a.png: there is no folder no"),
    ],
)
def test_what_can_not_be_done_is_one_line_and_leaves_no_file(plot, tmp_path, arguments, message):
    code, said = plot(*arguments)
    assert code == 2
    assert message in said
    assert said.count("\n") == 0
    assert list(tmp_path.iterdir()) == []
