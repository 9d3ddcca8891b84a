"""Laws that never return, in each command: the line is named, what was recorded is kept."""

import os
import re
import signal
import subprocess
import sys

import pytest

import mars2d
from tests.processes import PATIENCE, wait_until

HANGING = """\
from mars2d import Robot, Scenario


def go(robot):
    while robot.time > 0.45:
        v = 0.2
    return 0.2, 0


def scenario(speed=1.0):
    return Scenario(robots=[Robot(name="red", controller=go)], stop_time=2)


def measures(record):
    return {"x": record.pose[-1, 0, 0]}
"""


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An experiment in an empty folder, which is the current one."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MARS2D_PATIENCE", "0.5")
    (tmp_path / "hangs.py").write_text(HANGING)
    return tmp_path


def command(*words, **environment):
    """Start a command line."""
    return subprocess.Popen(
        [sys.executable, "-m", "mars2d", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, env=os.environ | environment,
    )  # fmt: skip


def ended(process):
    """Return exit code, output and errors of a command, which is ended whatever happens."""
    try:
        out, errors = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
    return process.returncode, out, errors


def test_a_run_names_line_robot_and_time_and_keeps_its_record(here):
    code, _, errors = ended(command("run", "hangs.py", "--headless", "--record", "kept.npz"))
    assert code == 2
    assert re.search(
        r"mars2d: hangs.py, line [56]: go did not return within 0.5 s \(red, at 0.5 s\)\n", errors
    )
    record = mars2d.load("kept.npz")
    assert record.time[-1] == pytest.approx(0.4)
    assert "did not return" in record.over_message


def test_a_sweep_has_it_in_its_row(here):
    _, out, errors = ended(
        command("sweep", "hangs.py", "--set", "speed=1,2", "--out", "s.csv", "--workers", "2")
    )
    assert "go did not return within 0.5 s (red, at 0.5 s)" in out + errors
    rows = (here / "s.csv").read_text()
    assert rows.count("go did not return within 0.5 s (red, at 0.5 s)") == 2


def test_from_python_it_is_the_laws_error(here):
    (here / "own.py").write_text(
        HANGING + "\nimport mars2d\ntry:\n    mars2d.run(scenario())\n"
        "except mars2d.LawError as error:\n    print(error, len(error.record))\n"
    )
    done = subprocess.run(
        [sys.executable, "own.py"], capture_output=True, text=True, timeout=PATIENCE, check=True
    )
    assert "go did not return within 0.5 s (red, at 0.5 s) 5\n" in done.stdout


def long_run(here, **environment):
    """Start a run that goes on for a week, and wait until it goes."""
    (here / "long.py").write_text(
        "from mars2d import Scenario\n"
        "scenario = Scenario(stop_time=6e5)\n"
        "def control(world):\n"
        "    if world.iteration == 20:\n        open('going', 'w').close()\n"
        "    while world.iteration == HANG:\n        pass\n"
        "    return 0, 0\n".replace("HANG", environment.pop("at", "-1"))
    )
    process = command("run", "long.py", "--headless", "--record", "kept.npz", **environment)
    wait_until((here / "going").exists, process)
    return process


@pytest.mark.parametrize("at", ["-1", "20"])
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT], ids=["SIGTERM", "Ctrl-C"])
def test_a_signal_ends_a_run_and_saves_it(here, number, at):
    process = long_run(here, at=at, MARS2D_PATIENCE="0")
    process.send_signal(number)
    code, _, errors = ended(process)
    assert code == 130, errors
    record = mars2d.load("kept.npz")
    assert len(record) > 10
    assert "Ctrl-C" in record.over_message


def test_a_run_that_was_stopped_meanwhile_goes_on(here):
    process = long_run(here, MARS2D_PATIENCE="0.2")
    process.send_signal(signal.SIGSTOP)
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(2)  # many times the patience
    process.send_signal(signal.SIGCONT)
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(0.5)
    process.send_signal(signal.SIGTERM)
    code, _, errors = ended(process)
    assert code == 130, errors


def test_a_signal_that_was_ignored_at_the_start_stays_ignored(here):
    start = (
        "import os, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
        "os.execv(sys.executable, [sys.executable, '-m', 'mars2d', *sys.argv[1:]])\n"
    )
    long = long_run(here)
    long.kill()
    long.communicate()
    (here / "going").unlink()
    process = subprocess.Popen(
        [sys.executable, "-c", start, "run", "long.py", "--headless", "--record", "kept.npz"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    wait_until((here / "going").exists, process)
    process.send_signal(signal.SIGINT)
    process.send_signal(signal.SIGTERM)
    code, _, errors = ended(process)
    assert code == 130, errors
    assert len(mars2d.load("kept.npz")) > 10
