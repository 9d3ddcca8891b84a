"""Sweeps: what is run, what a row holds, how a study goes on, what it refuses."""

from __future__ import annotations

import os
import signal
from concurrent.futures import ThreadPoolExecutor

import pytest

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.cli.command_line import main
from mars2d.study.table import Table
from tests.cases import each_case
from tests.processes import PATIENCE, begun, wait_until

DRIFT = '''
"""Robots drift."""
from pathlib import Path
from mars2d import Robot, Scenario

def law(robot):
    if robot.time == 0.0:
        with Path("ran.txt").open("a") as file:
            file.write(".")
    return gain * robot.rng.uniform(), 0.0

def scenario(gain=1.0, n=1, seed=0):
    globals()["gain"] = gain
    robots = [Robot(pose=(0, 0.4 * k, seed), controller=law) for k in range(n)]
    return Scenario(title="Drift", robots=robots, stop_time=1.0)

def far(record):
    return float(abs(record.pose[-1, :2]).max())

def near(record):
    return -far(record)

def word(record):
    return "much" if far(record) > 0.5 else None

def broken(record):
    return 1 / 0

def two(record, other):
    return 0
'''


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder with an experiment, which notes each robot that it runs."""
    monkeypatch.chdir(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    (tmp_path / "drift.py").write_text(DRIFT)
    return tmp_path


def sweep(settings=None, seeds=2, measures="far", experiment="drift.py", **more):
    """Sweep in a thread of this process, which starts at once."""
    with ThreadPoolExecutor(1) as executor:
        more = {"executor": executor} | more
        return mars2d.sweep(experiment, settings, seeds, measures, **more)


def runs(folder):
    file = folder / "ran.txt"
    return len(file.read_text()) if file.exists() else 0


# -- what a row holds ------------------------------------------------------------------------------


def test_each_row_is_the_run_that_mars2d_run_makes(here):
    table = sweep({"gain": [0.5, 1.0], "robots.*.diameter": [0.2, 0.3]}, 2, stop_time=0.5)
    assert len(table) == 8
    assert table.settings == ("gain", "robots.*.diameter", "stop_time")
    for row, result in enumerate(table.results, 1):
        record = mars2d.run("drift.py", options=result.options, seed=result.seed)
        assert result.row == row
        assert result.digest == record.digest
        assert result.measures == {"far": abs(record.pose[-1, :2]).max()}
    assert len({result.digest for result in table.results}) == 4  # a size changes nothing here
    assert len({result.code for result in table.results}) == 1


def test_measures_are_the_files_the_ones_built_in_or_functions_given(here):
    def here_alone(record):
        return len(record)

    table = sweep(None, 1, ["far", "collisions", "word", here_alone])
    assert table.measures == ("far", "collisions", "word", "here_alone")
    record = mars2d.run("drift.py")
    assert table.results[0].measures == {
        "far": abs(record.pose[-1, :2]).max(), "collisions": 0, "word": None, "here_alone": 11
    }  # fmt: skip


def test_a_run_that_fails_is_a_row_with_its_error_and_the_others_go_on(here):
    law = "return 1 / (robot.rng.uniform() - 1.5) if gain < 1 else robot.speeed, 0.0"
    (here / "drift.py").write_text(DRIFT.replace("return gain * robot.rng.uniform(), 0.0", law))
    fine, failed = sweep({"gain": [0.5, 1.0]}, 1).results
    assert (fine.error, failed.digest, failed.measures) == ("", "", {"far": None})
    assert failed.error.startswith("drift.py, line 10: a robot has no 'speeed'")


def test_a_point_that_can_not_be_opened_is_a_row_with_its_error(here):
    table = sweep({"n": [1, 40]}, 2)
    assert [bool(result.error) for result in table.results] == [False, False, True, True]
    assert "starts outside the workspace" in table.failed[0].error


def test_a_measure_that_fails_leaves_the_run_its_digest_and_its_other_measures(here):
    (here / "drift.py").write_text(DRIFT.replace("1 / 0", "1 / (gain - 1)"))
    _, result = sweep({"gain": [0.5, 1.0]}, 1, ["broken", "far"]).results
    assert result.digest
    assert result.measures["broken"] is None
    assert result.measures["far"] > 0
    assert "drift.py, line 27: broken raised ZeroDivisionError" in result.error


def test_a_run_that_takes_too_long_is_a_row_that_names_the_line(here):
    loop = "while gain == 2.0: pass\n    return 0.1, 0.0"
    (here / "drift.py").write_text(DRIFT.replace("return gain * robot.rng.uniform(), 0.0", loop))
    hangs, ends = sweep({"gain": [2.0, 1.0]}, 1, time_limit=0.5).results
    assert hangs.error == "took longer than 0.5 s, in drift.py, line 10"
    assert (ends.error, bool(ends.digest)) == ("", True)


# -- what stops after a few runs -------------------------------------------------------------------


def test_a_sweep_whose_every_run_fails_has_the_reason_and_exit_code_1(here, capsys):
    (here / "drift.py").write_text(DRIFT.replace("gain * robot", "1 / 0 * robot"))
    grid = ["--set", "gain=0.1:1:3", "--measure", "far", "--out", "r.csv", "--workers", "1"]
    assert main(["sweep", "drift.py", *grid]) == 1
    assert capsys.readouterr().err == (
        "mars2d: all runs failed: drift.py, line 10: law raised ZeroDivisionError: "
        "division by zero (robot0, at 0 s)\n"
    )
    assert len(Table.load("r.csv").failed) == 3


# -- records that are kept -------------------------------------------------------------------------


@pytest.mark.slow
def test_kept_records_are_measured_again_without_a_run(here, capsys):
    words = ["sweep", "drift.py", "--set", "gain=0.5,1", "--seeds", "2", "--keep"]
    assert main([*words, "--measure", "far", "--out", "r.csv"]) == 0
    assert capsys.readouterr().out.endswith("table:  r.csv\nrecords: r_records\n")
    far, made = Table.load("r.csv"), runs(here)
    assert (made, len(list((here / "r_records").iterdir()))) == (4, 4)
    assert main([*words, "--measure", "near,far", "--out", "r.csv"]) == 0
    table = Table.load("r.csv")
    assert runs(here) == made
    for before, result in zip(far.results, table.results, strict=True):
        assert (result.error, result.digest) == ("", before.digest)
        assert result.measures == {"near": -before.measures["far"], **before.measures}
    rows = (here / "r.csv").read_bytes()
    for file in (here / "r_records").iterdir():
        file.unlink()
    assert main([*words, "--measure", "word", "--out", "r.csv"]) == 2  # the rows would be lost
    assert (here / "r.csv").read_bytes() == rows


def test_records_of_a_file_that_has_changed_are_not_measured(here):
    sweep(out="r.csv", keep=True)
    (here / "drift.py").write_text(DRIFT.replace("uniform()", "uniform() / 2"))
    with pytest.raises(InputError, match="holds another study"):
        sweep(out="r.csv", keep=True)
    (here / "r.csv").unlink()
    sweep(out="r.csv", keep=True)
    assert runs(here) == 4


@each_case(
    "how, said",
    [
        ({"keep": True}, "keep: expected out as well"),
        ({"keep": True, "out": "r.csv", "control": lambda w: (0, 0)}, "keep: expected an exp"),
        (
            {
                "keep": True,
                "out": "r.csv",
                "measures": "collisions",
                "experiment": Scenario(robots=[Robot(pose=(0, 0, 0))], stop_time=1),
            },
            "keep: expected",
        ),
    ],
)
def test_records_are_kept_beside_a_table_of_an_experiment_in_a_file(here, how, said):
    with pytest.raises(InputError, match=said):
        sweep(**how)


# -- what is refused before the first run ----------------------------------------------------------


@each_case(
    "how, said",
    [
        ({"measures": "farr"}, "there is no measure 'farr'; did you mean 'far'?"),
        ({"measures": "two"}, "two(record, other) is no measure"),
        ({"measures": "capture_time"}, "this experiment has none"),
        ({"measures": ["far", "far"]}, "measure 'far': is there twice"),
        ({"measures": 3}, "measures = 3: expected names"),
        ({"settings": {"gian": [1, 2]}}, "there is no option 'gian'; did you mean 'gain'?"),
        ({"settings": {"gain": ["much"]}}, "scenario(gain) = 'much': expected a number"),
        ({"settings": {"n": [40, 50]}}, "starts outside the workspace"),
        ({"settings": {"seed": [1, 2]}}, "seeds are not a setting"),
        ({"settings": {"error": [1]}}, "setting 'error': is a column of each table"),
        ({"settings": {"far": [1]}}, "measure 'far': is a setting as well"),
        ({"settings": {"stop_time": 1}, "stop_time": 2}, "stop_time is given twice"),
        ({"experiment": "drfit.py"}, "there is no such file; did you mean 'drift.py'?"),
        ({"experiment": 3}, "experiment = 3: expected a file"),
        ({"seeds": 0}, "seeds = 0"),
        ({"time_limit": -1}, "time_limit = -1"),
        ({"out": "a.xlsx"}, "a.xlsx: expected a name that ends in .csv"),
        ({"out": "none/a.csv"}, "a.csv: can't be written"),
        ({"executor": None, "workers": 0}, "workers=0"),
        ({"executor": 3}, "executor=3"),
    ],
)
def test_what_can_not_be_run_is_said_before_the_first_run(here, how, said):
    with pytest.raises(InputError) as caught:
        sweep(**how)
    assert said in str(caught.value)
    assert runs(here) == 0


# -- going on --------------------------------------------------------------------------------------


def test_what_is_in_the_file_is_not_run_again_and_seeds_and_values_may_become_more(here):
    first = sweep({"gain": [0.5, 1.0]}, 2, out="r.csv")
    assert Table.load("r.csv") == first
    assert runs(here) == 4
    assert sweep({"gain": [0.5, 1.0]}, 2, out="r.csv") == first
    assert runs(here) == 4
    more = sweep({"gain": [0.25, 0.5, 1.0]}, 3, out="r.csv")
    assert runs(here) == 9
    again = sweep({"gain": [0.25, 0.5, 1.0]}, 3, out="again.csv")
    assert more == again == Table.load("r.csv")
    assert (here / "r.csv").read_bytes() == (here / "again.csv").read_bytes()


def test_rows_with_errors_are_run_again_only_if_asked(here):
    law = 'return (1 / 0 if Path("bad").exists() and robot.pose[2] else 0.1), 0.0'
    (here / "drift.py").write_text(DRIFT.replace("return gain * robot.rng.uniform(), 0.0", law))
    (here / "bad").touch()
    assert len(sweep(None, 2, out="r.csv").failed) == 1
    (here / "bad").unlink()
    assert len(sweep(None, 2, out="r.csv").failed) == 1
    assert runs(here) == 2
    assert sweep(None, 2, out="r.csv", retry=True).failed == ()
    assert runs(here) == 3


@each_case(
    "how, said",
    [
        ({"seeds": 1}, "it has the seed 1, which this one has not"),
        ({"settings": {"gain": [0.5, 2.0]}}, "it has gain = 1.0, which this one has not"),
        ({"settings": {"n": [1]}}, "its settings: gain; now: n"),
        ({"measures": ["far", "word"]}, "its measures: far; now: far, word"),
        ({"experiment": "./other.py"}, "its experiment: drift.py; now: other.py"),
    ],
)
def test_a_file_of_another_study_is_refused(here, how, said):
    (here / "other.py").write_text(DRIFT)
    same = {"settings": {"gain": [0.5, 1.0]}, "out": "r.csv"}
    sweep(**same)
    before = (here / "r.csv").read_bytes()
    with pytest.raises(InputError) as caught:
        sweep(**(same | how))
    assert str(caught.value).startswith("r.csv: holds another study; " + said)
    assert "Give another --out, or delete it" in str(caught.value)
    assert (here / "r.csv").read_bytes() == before


def test_a_file_made_by_other_code_is_refused(here):
    (here / "beside.py").write_text("STEP = 0.4\n")
    (here / "drift.py").write_text("from beside import STEP\n" + DRIFT.replace("0.4", "STEP"))
    sweep({"gain": [0.5]}, out="r.csv")
    (here / "beside.py").write_text("STEP = 0.5\n")
    with pytest.raises(InputError, match="has changed since row 1 was made"):
        sweep({"gain": [0.5]}, 3, out="r.csv")
    (here / "beside.py").write_text("STEP = 0.4\n")
    assert len(sweep({"gain": [0.5]}, 3, out="r.csv")) == 3


# -- the command -----------------------------------------------------------------------------------

COMMAND = ["sweep", "drift.py", "--set", "gain=0.5,1.0", "--seeds", "20", "--measure", "far"]


def once_rows(file, count, process):
    """Wait until a file has some rows, and return them."""

    def rows():
        return file.read_bytes().split(b"\r\n")[1:-1] if file.exists() else []

    wait_until(lambda: len(rows()) >= count, process)
    return rows()


@pytest.mark.slow
def test_interrupted_and_killed_it_goes_on_and_the_file_is_that_of_one_worker(here):
    slow = DRIFT.replace("return gain", "__import__('time').sleep(0.005)\n    return gain")
    (here / "drift.py").write_text(slow)
    study = [*COMMAND, "--out", "r.csv", "--workers", "2"]

    with begun(*study, start_new_session=True) as process:
        once_rows(here / "r.csv", 3, process)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        _, errors = process.communicate()
    rows = len(Table.load("r.csv"))
    assert process.returncode == 130, errors
    assert errors == f"mars2d: {rows} of 40 runs are in r.csv; the same command goes on\n"
    assert 3 <= rows < 40

    with begun(*study, start_new_session=True) as process:
        once_rows(here / "r.csv", rows + 3, process)
        process.kill()
    with (here / "r.csv").open("ab") as file:
        file.write(b"17,drift.py,0.5,1,0.2")  # what a full disk or a power failure leaves
    there = len(Table.load("r.csv"))
    assert rows + 3 <= there < 40

    (here / "ran.txt").unlink()
    sweep({"gain": [0.5, 1.0]}, 20, out="r.csv")
    assert runs(here) == 40 - there
    sweep({"gain": [0.5, 1.0]}, 20, out="one.csv")
    assert (here / "r.csv").read_bytes() == (here / "one.csv").read_bytes()


def test_a_table_that_is_there_is_summed_up_compared_and_drawn(here, capsys):
    sweep({"gain": [0.5, 1.0]}, 3, out="r.csv")
    before = runs(here)
    assert main(["sweep", "r.csv", "--compare", "gain", "--figure", "r.png"]) == 0
    out = capsys.readouterr().out
    assert "6 runs of drift.py" in out
    assert "differences from gain = 0.5" in out
    assert out.endswith("table:  r.csv\nfigure: r.png\n")
    assert (here / "r.png").stat().st_size > 5_000
    assert main(["sweep", "r.csv", "--figure", "r.svg"]) == 0
    assert "<svg" in (here / "r.svg").read_text()
    assert runs(here) == before


def test_points_that_can_not_be_opened_are_said_before_the_first_run(here, capsys):
    assert main([*COMMAND[:2], "--set", "n=1,40", "--workers", "1"]) == 0
    out, errors = capsys.readouterr()
    assert errors.startswith("mars2d: drift.py, line 15, with n = 40")
    assert "1 run failed" in out
    assert len(Table.load("sweep.csv").failed) == 1


def test_ctrl_c_in_python_leaves_the_rows_that_were_made(here):
    with pytest.raises(KeyboardInterrupt) as caught:
        sweep({"gain": [0.5, 1.0]}, 5, measures=["far", _interrupting])
    made = [(result.options["gain"], result.seed) for result in caught.value.table.results]
    assert 1 <= len(made) <= 4  # the main thread may be behind the rows that are made
    assert made == [(0.5, seed) for seed in range(len(made))]
    assert str(caught.value) == f"{len(made)} of 10 runs were made"


def _interrupting(record):
    if record.seed == 3:
        signal.raise_signal(signal.SIGINT)  # to the main thread, which waits
    return 0


NOTEBOOK = """
import mars2d

def last(record):
    return record.time[-1]

mars2d.sweep("drift.py", {"gain": [0.5, 1.0]}, 2, last, workers=2)
"""


@pytest.mark.slow
def test_a_notebook_shows_a_bar_and_its_functions_go_to_processes(here):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(NOTEBOOK)])
    nbclient.NotebookClient(notebook, timeout=PATIENCE).execute()
    *shown, table = notebook.cells[0].outputs
    assert "0/4 [" in str(shown)
    assert "Table of drift.py: 4 runs" in table["data"]["text/plain"]
