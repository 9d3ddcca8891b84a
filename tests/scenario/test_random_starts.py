"""A scenario function with a parameter `seed` gets that of the run: starts are drawn at random."""

import json

import pytest

import mars2d
from mars2d import InputError, World
from mars2d.cli import command_line as cli
from mars2d.scenario.experiment import open_experiment
from mars2d.world.timeline import Timeline

FILE = """
from mars2d import Robot, Scenario
def law(robot):
    return 0.1, 0.0
def scenario(gap=1.0, seed=99):
    return Scenario(robots=[Robot(controller=law).at(0, gap * seed)], workspace=None, stop_time=0.2)
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "drawn.py"
    path.write_text(FILE)
    return path


def start(record):
    return float(record.pose[0, 1, 0])


def test_a_scenario_function_gets_the_seed_of_the_run(file):
    assert start(mars2d.run(file)) == 0.0
    record = mars2d.run(file, seed=3, options={"gap": 0.5})
    assert (start(record), record.seed) == (1.5, 3)
    assert start(mars2d.run(mars2d.scenario.experiment.open_module(file), seed=4)) == 4.0


def test_who_sets_the_seed_as_an_option_has_the_same_start_with_other_luck(file):
    record = mars2d.run(file, seed=3, options={"seed": 5})
    assert (start(record), record.seed) == (5.0, 3)


def test_a_function_without_such_a_parameter_is_called_without(file):
    file.write_text(FILE.replace("seed=99", "offset=2").replace("gap * seed", "gap * offset"))
    assert start(mars2d.run(file, seed=3)) == 2.0
    with pytest.raises(InputError, match="there is no option 'seed'"):
        mars2d.run(file, options={"seed": 3})


def test_a_seed_that_can_not_be_is_refused_before_the_function_sees_it(file, capsys):
    file.write_text(
        FILE.replace("    return Scenario", "    assert False, seed\n    return Scenario")
    )
    for seed in (-1, 2**63, 1.5, "3"):
        with pytest.raises(InputError, match=r"^seed = .*: expected a whole number from 0"):
            mars2d.run(file, seed=seed)
    assert cli.main(["run", str(file), "--headless", "--seed", "-1"]) == cli.BAD_INPUT
    assert "seed = -1: expected a whole number" in capsys.readouterr().err


def test_an_experiment_that_is_opened_again_keeps_the_seed(file):
    experiment = open_experiment(file, {"gap": 2.0}, seed=3)
    assert experiment.scenario.robots[0].pose[1] == 6.0
    file.write_text(FILE.replace("at(0, gap", "at(1, gap"))
    assert experiment.reopened().scenario.robots[0].pose[:2] == (1.0, 6.0)
    assert experiment.reopened().reopened().scenario.robots[0].pose[:2] == (1.0, 6.0)


def test_a_window_that_reads_the_file_again_keeps_it_too(file):
    timeline = Timeline(open_experiment(file, seed=3), 3)
    file.write_text(FILE.replace("0.1, 0.0", "0.2, 0.0"))
    timeline.restart(timeline.experiment.reopened())
    timeline.advance()
    assert float(timeline.world.pose[1, 0]) == 3.0
    assert timeline.world.record.seed == 3


def test_the_command_line_passes_it_on(file, tmp_path, capsys):
    saved = tmp_path / "run.npz"
    run = ["run", str(file), "--headless", "--json", "--seed", "4", "--record", str(saved)]
    assert cli.main(run) == 0
    assert start(mars2d.load(saved)) == 4.0
    assert json.loads(capsys.readouterr().out)["seed"] == 4
    assert cli.main([*run, "--set", "seed=6"]) == 0
    assert start(mars2d.load(saved)) == 6.0
    capsys.readouterr()
    digests = set()
    for seed in ("4", "5"):
        assert cli.main(["compare", str(file), "--json", "--seed", seed]) == 0
        digests |= {run["digest"] for run in json.loads(capsys.readouterr().out)["runs"]}
    assert mars2d.run(file, seed=4).digest in digests
    assert mars2d.run(file, seed=5).digest in digests


def test_a_record_of_such_a_run_runs_again(file, tmp_path, capsys):
    saved = mars2d.run(file, seed=4).save(tmp_path / "run.npz")
    assert cli.main(["check", str(saved)]) == 0
    again = World(mars2d.load(saved).scenario, seed=4)
    assert float(again.pose[1, 0]) == 4.0
    assert "bit" in capsys.readouterr().out
