"""`Map.from_file` beside an experiment, and ``mars2d check`` of a map."""

from __future__ import annotations

import pytest

import mars2d
from mars2d import Scenario
from mars2d.addons import Map
from mars2d.cli.command_line import main
from mars2d.scenario.experiment import open_experiment
from tests.cases import each_case
from tests.processes import mars

SQUARE = '{"type": "LineString", "coordinates": [[0, 0], [6, 0], [6, 4], [0, 4], [0, 0]]}'
WALL = '{"type": "LineString", "coordinates": [[0, 0], [1, 0]]}'


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Each test has a folder with the map of a room, and an experiment in another one."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "room.json").write_text(SQUARE)
    (tmp_path / "lab").mkdir()
    return tmp_path


def test_a_map_is_looked_for_beside_the_experiment_then_in_the_current_folder(folder):
    (folder / "lab" / "own.json").write_text(WALL)
    path = folder / "lab" / "walk.py"
    path.write_text(
        "from mars2d import *\nfrom mars2d.addons import *\n"
        "def scenario(map='own.json'):\n"
        "    return Scenario(robots=[Robot(pose=(2, 2, 0))], addons=[Map.from_file(map)])"
    )

    def walls(**options):
        (found,) = open_experiment(path, options).scenario.addons
        return found.walls

    assert walls() == (((0, 0), (1, 0)),)
    assert len(walls(map="room.json")[0]) == 5


def test_a_record_keeps_the_walls_not_the_file(folder):
    chart = Map.from_file("room.json")
    scenario = Scenario(robots=[mars2d.Robot(pose=(3, 2, 0))], addons=[chart])
    record = mars2d.run(scenario, stop_time=1)
    record.save("run.npz")
    (folder / "room.json").unlink()
    assert mars2d.load("run.npz").scenario.obstacles == record.scenario.obstacles


# -- the command line --------------------------------------------------------------------------


@pytest.mark.slow
def test_check_shows_what_was_read():
    done = mars("check", "room.json", "--set", "unit=cm", "--set", "at=(0,1)")
    assert done.stderr == ""
    assert done.stdout.splitlines() == [
        "map         room.json, GeoJSON",
        "size        0.06 m x 0.04 m",
        "from, to    (0, 1), (0.06, 1.04)",
        "unit        cm, as given",
        "hint        0.06 m is small for a map of robots: is it unit=m (6 m)?",
        "obstacles   1 wall",
        "corners     5, within 0.02 m",
    ]


@each_case(
    ("words", "said"),
    [
        (["room.json", "--set", "units=cm"], "--set units: no option; did you mean 'unit'?"),
        (
            ["plan.dwg"],
            "plan.dwg: expected a Python file (.py), a learned law (.onnx), a scenario (.toml)",
        ),
        (["rom.json"], "rom.json: there is no such file; did you mean 'room.json'?"),
        (["plan.dwg"], "; save the drawing as DXF"),
    ],
)
def test_check_says_what_it_can_not_do(words, said, capsys):
    assert main(["check", *words]) == 2
    assert said in capsys.readouterr().err
