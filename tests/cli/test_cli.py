"""The command line as a student types it: its output and exit codes."""

import argparse
import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import Scenario, World
from mars2d.cli import command_line as cli
from mars2d.cli.outputs import run_and_save
from tests.cases import each_case
from tests.processes import mars

HEAD = "import numpy as np\nfrom mars2d import *\nfrom mars2d.addons import Map\n"


@pytest.mark.slow
def test_demo_without_a_display_makes_a_picture_and_a_film_and_says_where(tmp_path):
    from PIL import Image

    done = mars("demo", "go_to_point", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    paths = [line.split()[1] for line in done.stdout.splitlines() if "mars2d_demo" in line]
    assert len(paths) == 2
    with Image.open(tmp_path / paths[0]) as picture, Image.open(tmp_path / paths[1]) as film:
        assert picture.format == "PNG"
        assert film.format == "GIF"
        assert film.n_frames > 50


def test_run_prints_its_outcome_as_one_line_of_json(typed):
    code, out, err = typed("run", "random_walk", "--headless", "--stop-time", 20, "--json")
    assert (code, err, out.count("\n")) == (0, "", 1)
    outcome = json.loads(out)
    record = mars2d.run("random_walk", stop_time=20)
    assert outcome["ticks"] == 20
    assert outcome["time"] == 20.0
    assert outcome["over"] is True
    assert outcome["message"] == record.over_message
    assert outcome["digest"] == record.digest
    assert outcome["collisions"] == record.collisions
    assert outcome["seed"] == 0
    assert outcome["wall_s"] > 0


def test_set_overrides_fields_and_parameters(typed):
    code, *_ = typed(
        "run", "follow_the_leader", "--headless", "--stop-time", 1, "--record", "a.npz",
        "--set", "followers=2", "--set", "robots.*.diameter=0.2", "--set", "sampling_time=0.5",
    )  # fmt: skip
    assert code == 0
    record = mars2d.load("a.npz")
    assert [robot.diameter for robot in record.scenario.robots] == [0.2] * 3
    assert record.time.tolist() == [0.0, 0.5, 1.0]


def test_check_says_where_a_record_departs(tmp_path, capsys):
    record = mars2d.run("follow_the_leader", stop_time=5)
    pose = record.pose.copy()
    pose[30:, 0, 1] += 0.25
    replace(record, pose=pose).save(tmp_path / "a.npz")
    assert cli.main(["check", str(tmp_path / "a.npz")]) == 1
    assert (
        "departs at row 30, at 3 s: the pose of follower1 is off by 0.25 m"
        in capsys.readouterr().err
    )


@pytest.mark.slow
def test_check_describes_an_experiment_and_tries_its_laws(typed):
    code, out, _ = typed("check", "own_sensor_and_addon")
    assert code == 0
    for word in ("Light seekers", "eyes", "lamps", "10 m x 10 m", "sound"):
        assert word in out


def test_list_names_every_part_with_one_line(typed):
    _, out, _ = typed("list")
    for name in ("random_walk", "Unicycle", "Holonomic", "Proximity", "Map"):
        [line] = [x for x in out.splitlines() if x.split()[:1] == [name]]
        assert len(line.split()) > 4


def test_what_was_recorded_before_a_law_failed_is_kept(typed):
    Path("late.py").write_text(
        HEAD + "scenario = Scenario()\n"
        "def control(world):\n    return 0.1, 1 / (10 - world.iteration)\n"
    )
    assert typed("run", "late.py", "--headless", "--record", "kept.npz")[0] == 2
    record = mars2d.load("kept.npz")
    assert len(record) == 10
    assert "ZeroDivisionError" in record.over_message
    assert np.isfinite(record.pose).all()


def test_a_record_with_parts_of_the_users_own_can_be_drawn_and_run_again(tmp_path, capsys):
    from mars2d.output.raster.picture import paint_frame

    path = mars2d.run("own_sensor_and_addon").save(tmp_path / "own.npz")
    record = mars2d.load(path)
    assert record.missing == ("sensor Eyes", "add-on Lamps")
    paint_frame(record.frame(-1), (320, 240), sensors=True)
    assert cli.main(["check", str(path)]) == 0
    shown = capsys.readouterr().out
    assert "sensor Eyes" in shown
    assert "bit-identical" in shown


def test_an_experiment_may_import_what_lies_beside_it_and_two_do_not_meet(tmp_path):
    for k in (1, 2):
        folder = tmp_path / str(k)
        folder.mkdir()
        (folder / "helper.py").write_text(f"END = {k}\n")
        (folder / "main.py").write_text(
            "from helper import END\nfrom mars2d import Scenario\n"
            "scenario = Scenario(stop_time=END)\n"
        )
    ends = [mars2d.run(tmp_path / str(k) / "main.py").time[-1] for k in (1, 2)]
    assert ends == [1.0, 2.0]
    assert "helper" not in sys.modules


# -- experiments that check themselves --------------------------------------------------------

ROLL = """\
'''How far does a robot roll?

v t, as long as nothing is in its way.
'''
from mars2d import Prediction, Scenario

scenario = Scenario(stop_time=2)

def control(world):
    return 0.25, 0.0

def checks(record):
    path = record.pose[-1, 0, 0]
    yield Prediction("path", 0.25 * 2, path, 1e-9, "m")
    yield Prediction("path, if it were slower", 0.2 * 2, path, 0.02, "m")
    yield Prediction("time of the first contact", 1, float("nan"), 0.1, "s")
"""


@pytest.fixture
def roll(tmp_path):
    (tmp_path / "roll.py").write_text(ROLL)
    return tmp_path / "roll.py"


def test_a_run_prints_what_was_predicted_and_measured_after_its_outcome(roll, capsys):
    assert cli.main(["run", str(roll), "--headless"]) == 0  # a wrong prediction is no wrong input
    outcome, *rest = capsys.readouterr().out.splitlines()
    assert "finished after 2 s" in outcome
    assert rest == [
        "",
        "How far does a robot roll?",
        "                              predicted      measured  tolerance",
        "path                       0.5000000000  0.5000000000      1e-09  m  ok",
        "path, if it were slower           0.400         0.500       0.02  m  NOT OK",
        "time of the first contact          1.00  not a number        0.1  s  NOT OK",
        "1 of 3 predictions ok",
    ]


def test_the_checks_stand_in_the_json(roll, capsys):
    assert cli.main(["run", str(roll), "--headless", "--json"]) == 0
    text = capsys.readouterr().out
    assert text.count("\n") == 1
    first, second, third = json.loads(text)["checks"]
    assert first.pop("measured") == pytest.approx(0.5, abs=1e-9)
    assert first == {
        "name": "path",
        "predicted": 0.5,
        "tolerance": 1e-9,
        "bound": "equal",
        "ok": True,
    }
    assert second["ok"] is False
    assert third["measured"] is None
    assert third["ok"] is False


@each_case("options", [[], ["--json"]])
def test_checks_that_fail_lose_no_data(roll, tmp_path, capsys, options):
    roll.write_text(ROLL.replace('1, float("nan")', "1, record.contacts['time'][0]"))
    paths = [tmp_path / name for name in ("a.npz", "a.png", "a.gif")]
    outputs = ["--record", str(paths[0]), "--figure", str(paths[1]), "--video", str(paths[2])]
    outputs += ["--size", "160x120"]
    assert cli.main(["run", str(roll), "--headless", *outputs, *options]) == 2
    shown = capsys.readouterr()
    assert shown.err.startswith("mars2d: roll.py, line 16: checks raised IndexError")
    assert shown.err.count("\n") == 1
    assert ("finished after 2 s" in shown.out) is not bool(options)
    assert mars2d.load(paths[0]).finished
    assert all(path.stat().st_size > 100 for path in paths)


def test_a_window_may_be_closed_before_the_first_step():
    nothing = argparse.Namespace(**dict.fromkeys(("record", "figure", "html", "video", "at")))
    record, made, troubles = run_and_save(nothing, lambda: World(Scenario()).record)
    assert (len(record), made, troubles) == (0, {}, [])
