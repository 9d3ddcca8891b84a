"""The option ``map`` of a run, `Map.from_file` beside an experiment, and ``mars2d check``."""

from __future__ import annotations

import pytest

import mars2d
from mars2d import InputError, Scenario
from mars2d.addons import Map
from mars2d.cli.command_line import main
from mars2d.scenario.experiment import open_experiment
from tests.cases import each_case
from tests.processes import mars

SQUARE = "LINESTRING (0 0, 6 0, 6 4, 0 4, 0 0)"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Each test has a folder with the map of a room, and an experiment in another one."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.wkt").write_text(SQUARE)
    (tmp_path / "lab").mkdir()
    return tmp_path


def experiment(folder, scenario):
    path = folder / "lab" / "walk.py"
    path.write_text(
        "from mars2d import *\nfrom mars2d.addons import *\n"
        f"{scenario}\ndef control(world):\n    return 0.1, 0.0\n"
    )
    return path


def test_a_map_takes_the_place_of_the_scenarios_and_keeps_its_surface(folder):
    path = experiment(
        folder,
        "scenario = Scenario(robots=[Robot(pose=(2, 2, 0))],"
        " addons=[Map([[(0, 0), (1, 0)]], friction=0.2, name='walls')])",
    )
    scenario = open_experiment(path, {"map": "room.wkt"}).scenario
    (found,) = scenario.addons
    assert len(found.obstacles()) == 4
    assert (found.friction, found.key) == (0.2, "walls")


@each_case(
    ("workspace", "expected"),
    [
        ("", (-1, 7, -1, 5)),  # the default one
        ("workspace=[(0, 0), (5, 0), (5, 5), (0, 5)]", (-1, 7, -1, 5)),  # smaller than the map
        ("workspace=[(-9, -9), (9, -9), (9, 9), (-9, 9)]", (-9, 9, -9, 9)),  # the map fits
    ],
)
def test_the_workspace_becomes_the_maps_unless_it_is_larger(folder, workspace, expected):
    path = experiment(folder, f"scenario = Scenario(robots=[Robot(pose=(2, 2, 0))], {workspace})")
    assert open_experiment(path, {"map": "room.wkt"}).scenario.bounds == expected


def test_how_it_is_read_is_set_by_options_of_the_map(folder):
    path = experiment(folder, "scenario = Scenario(robots=[Robot(pose=(2, 2, 0))])")
    options = {"map": "room.wkt", "map.unit": 2, "map.at": (-1, -1), "map.tolerance": 0.1}
    assert open_experiment(path, options).scenario.bounds == (-2, 12, -2, 8)


def test_the_parameter_map_of_a_scenario_function_gets_the_value(folder):
    (folder / "lab" / "own.wkt").write_text("LINESTRING (0 0, 1 0)")
    path = experiment(
        folder,
        "def scenario(map='own.wkt'):\n"
        "    return Scenario(robots=[Robot(pose=(2, 2, 0))], addons=[Map.from_file(map)])",
    )

    def size(**options):
        (found,) = open_experiment(path, options).scenario.addons
        return found.walls

    assert size() == (((0, 0), (1, 0)),)  # beside the experiment
    assert len(size(map="room.wkt")[0]) == 5  # in the current folder
    assert size(**{"map.unit": 2}) == (((0, 0), (2, 0)),)  # its own, read otherwise
    assert size(map=Map([], walls=[[(0, 1), (1, 1)]])) == (((0, 1), (1, 1)),)


def test_in_python_a_map_can_be_given_as_it_is():
    scenario = Scenario(robots=[mars2d.Robot(pose=(3, 2, 0))])
    record = mars2d.run(scenario, stop_time=1, options={"map": Map.from_file("room.wkt")})
    assert len(record.scenario.obstacles) == 4
    record = mars2d.run(scenario, stop_time=1, options={"map": "room.wkt", "map.unit": "m"})
    assert len(record.scenario.obstacles) == 4


@each_case(
    ("options", "said"),
    [
        ({"map": "rom.wkt"}, "there is no such file beside walk.py or in the current folder; did"),
        ({"map": "lab"}, "lab: a folder; expected a map"),
        ({"map": 3}, "map = 3: expected the name of a map's file"),
        ({"map.unit": "cm"}, "map.unit needs map=FILE as well"),
        (
            {"map": "room.wkt", "map.units": 1},
            "there is no option 'map.units'; did you mean 'map.unit'?",
        ),
        ({"map": "room.wkt", "unit": "cm"}, "no option 'unit'; did you mean 'map.unit'?"),
        ({"map": "room.wkt", "workspace": [(0, 0)]}, "Scenario.workspace = [(0, 0)]: expected a"),
        ({"map": "room.wkt", "map.layers": "A"}, "room.wkt: layers is for .dxf, .svg"),
    ],
)
def test_what_is_wrong_with_the_option_is_said(folder, options, said):
    path = experiment(folder, "scenario = Scenario(robots=[Robot(pose=(2, 2, 0))])")
    with pytest.raises(InputError) as caught:
        open_experiment(path, options)
    assert said in str(caught.value)
    assert str(caught.value).startswith("walk.py: ")


def test_a_record_keeps_the_walls_not_the_file(folder):
    scenario = Scenario(robots=[mars2d.Robot(pose=(3, 2, 0))])
    record = mars2d.run(scenario, stop_time=1, options={"map": "room.wkt"})
    record.save("run.npz")
    (folder / "room.wkt").unlink()
    assert mars2d.load("run.npz").scenario.obstacles == record.scenario.obstacles


# -- the command line --------------------------------------------------------------------------


@pytest.mark.slow
def test_check_shows_what_was_read_and_draws_it(folder):
    done = mars("check", "room.wkt", "--set", "unit=cm", "--set", "at=(0,1)")
    assert done.stderr == ""
    assert done.stdout.splitlines() == [
        "map         room.wkt, WKT",
        "size        0.06 m x 0.04 m",
        "from, to    (0, 1), (0.06, 1.04)",
        "unit        cm, as given",
        "hint        0.06 m is small for a map of robots: is it unit=m (6 m)?",
        "obstacles   1 wall",
        "corners     5, within 0.02 m",
    ]
    assert (folder / "a.png").read_bytes().startswith(b"\x89PNG")


@each_case(
    ("words", "said"),
    [
        (["room.wkt", "--set", "units=cm"], "--set units: no option; did you mean 'unit'?"),
        (
            ["plan.dwg"],
            "plan.dwg: expected a Python file (.py), a learned law (.onnx), a scenario (.toml)",
        ),
        (["rom.wkt"], "rom.wkt: there is no such file; did you mean 'room.wkt'?"),
        (["plan.dwg"], "; save the drawing as DXF"),
    ],
)
def test_check_says_what_it_can_not_do(words, said, capsys):
    assert main(["check", *words]) == 2
    assert said in capsys.readouterr().err
