"""A command ends: laws that hang, threads, processes and exit functions, signals, files."""

import os
import re
import signal
import subprocess
import sys

import pytest

import mars2d
from mars2d.study.table import Table
from tests.processes import PATIENCE, begun, mars, wait_until

pytestmark = pytest.mark.slow

LAW = """\
import atexit, subprocess, sys, threading, time
from mars2d import Robot, Scenario


def scenario(kind="goes"):
    def go(robot):
        if robot.time < 0.45:
            return 0.2, 0
        if robot.time > 1.95:
            open("going", "w").close()
        if kind == "spins":
            while True:
                pass
        if kind == "in C":
            time.sleep(1e6)
        if kind == "asks":
            input("How fast? ")
        if kind == "shows":
            import matplotlib.pyplot as plt
            plt.plot([1, 2])
            plt.show()
        if kind == "leaves":
            threading.Thread(target=time.sleep, args=(1e6,)).start()
            atexit.register(time.sleep, 1e6)
            subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
        return 0.2, 0
    stop = 1e6 if kind == "goes" else 2
    return Scenario(robots=[Robot(name="red", controller=go)], stop_time=stop)
"""


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An experiment in an empty folder, which is the current one."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "law.py").write_text(LAW)
    return tmp_path


def run(kind, more=""):
    """Run the experiment as a process of its own, to its end, by a shell."""
    line = f"run law.py --headless --set kind='{kind}' --record kept.npz {more}"
    return subprocess.run(
        ["sh", "-c", f"{sys.executable} -m mars2d {line}"],
        capture_output=True, text=True, timeout=PATIENCE, check=False, stdin=subprocess.DEVNULL,
    )  # fmt: skip


def test_a_law_that_hangs_is_named_and_its_record_kept(here, monkeypatch):
    monkeypatch.setenv("MARS2D_PATIENCE", "0.5")
    wrong = {
        "spins": r"line 1\d: go did not return within 0.5 s \(red, at 0.5 s\)",
        "in C": r"mars2d: law.py, line \d+ does not return: ended by force",
        "asks": r"EOFError: EOF when reading a line; nobody answers while a simulation runs",
    }
    for kind, said in wrong.items():
        done = run(kind)
        assert done.returncode == 2, (kind, done)
        assert re.search(said, done.stderr), (kind, done)
        assert "what was recorded until 0.4 s is in kept.npz" in done.stderr, kind
        assert "Traceback" not in done.stderr, kind
        assert len(mars2d.load("kept.npz")) == 5, kind
        os.remove("kept.npz")  # noqa: PTH107


def test_what_a_law_starts_or_shows_does_not_hold_the_command(here):
    for kind in ("leaves", "shows"):
        done = run(kind)
        assert done.returncode == 0, done
        assert "record: kept.npz" in done.stdout
        assert mars2d.load("kept.npz").finished


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_and_sigterm_end_a_run_and_save_it(here):
    for number in (signal.SIGINT, signal.SIGTERM):
        with begun("run", "law.py", "--headless", "--record", "kept.npz") as process:
            wait_until((here / "going").exists, process)
            process.send_signal(number)
            _, errors = process.communicate()
        assert (process.returncode, "Traceback" in errors) == (130, False), errors
        assert errors.endswith("is in kept.npz\nmars2d: interrupted\n")
        record = mars2d.load("kept.npz")
        assert len(record) > 10
        assert "Ctrl-C" in record.over_message
        (here / "going").unlink()


@pytest.mark.skipif(sys.platform != "linux", reason="needs /dev/full")
def test_standard_files_that_are_closed_or_full_cost_no_record(here):
    for more in ("<&- >&- 2>&-", ">/dev/full"):
        done = run("rests", more=more)
        assert done.returncode == (2 if more == ">/dev/full" else 0), (more, done)
        assert "Traceback" not in done.stderr, more
        assert len(mars2d.load("kept.npz")) == 21, more
        os.remove("kept.npz")  # noqa: PTH107


@pytest.mark.nightly
def test_a_sweep_has_the_laws_that_hang_in_its_rows(here):
    words = "--set", "kind=rests,spins,in C", "--workers", 2, "--time-limit", 3
    mars("sweep", "law.py", *words, "--out", "s.csv", cwd=here, MARS2D_PATIENCE="0.5")
    errors = [row.error for row in Table.load(here / "s.csv").results]
    assert errors[0] == ""
    assert "go did not return within 0.5 s (red, at 0.5 s)" in errors[1]
    assert "3 s" in errors[2]  # "took longer than 3 s", or in C code "at the time limit of 3 s"
