"""Everything ends: threads, code in C, a law that catches everything, and signals of all kinds."""

import os
import signal
import subprocess
import sys
import time

import pytest

import mars2d
from mars2d.study.table import load_table
from tests.faults.commands import started
from tests.processes import PATIENCE, running, wait_until

linux = pytest.mark.skipif(sys.platform != "linux", reason="needs prctl and /dev/full")

HEAD = """\
import itertools, multiprocessing, threading, time
from mars2d import Scenario

scenario = Scenario(stop_time=STOP)


def control(world):
    if world.iteration == 20:
        open("going", "w").close()
"""

SWALLOWS = """\
        while True:
            try:
                sum(range(1000))
            except:
                pass
"""

IN_C = "        sum(itertools.repeat(0))\n"
"""Never returns, holds the interpreter, and looks for no signal."""

THREAD = '        threading.Thread(target=time.sleep, args=(1e6,), name="mine").start()\n'

PROCESS = """\
        fork = multiprocessing.get_context("fork")
        fork.Process(target=time.sleep, args=(1e6,), name="mine").start()
"""

HELPERS = """\
        import subprocess
        subprocess.Popen(["sleep", "100000"])
        subprocess.Popen(["sh", "-c", "sleep 100001 & sleep 0.1"])
        subprocess.Popen("sleep 100002; sleep 100003", shell=True)
"""
"""A helper, one whose parent ends, and one that is the child of a shell."""

NOTHING = "        pass\n"


def experiment(folder, body, stop=6e5):
    (folder / "law.py").write_text(HEAD.replace("STOP", f"{stop:g}") + body + "    return 0, 0\n")


def going(folder, body, *words, **environment):
    """Start a run whose law is doing something, and wait until it is."""
    experiment(folder, body)
    words = words or ("run", "law.py", "--headless", "--record", "kept.npz")
    command = started(folder, *words, **({"MARS2D_PATIENCE": "0"} | environment))
    wait_until((folder / "going").exists)
    return command


def pressed_until_it_ends(command):
    """Press Ctrl-C now and then until a command has ended; return how."""
    while running(command.pid):
        command.interrupt()
        time.sleep(0.3)
    return command.end(PATIENCE)


@linux
def test_a_law_that_catches_everything_is_ended_by_a_second_ctrl_c_and_saved(tmp_path):
    ended = pressed_until_it_ends(going(tmp_path, SWALLOWS))
    assert ended.code == 130, ended
    assert "what was recorded until 1.9 s is in kept.npz" in ended.err
    assert "Traceback" not in ended.err
    record = mars2d.load(tmp_path / "kept.npz")
    assert (len(record), record.finished) == (20, False)


@linux
def test_its_log_is_whole(tmp_path):
    words = ("run", "law.py", "--headless", "--record", "kept.mcap")
    ended = pressed_until_it_ends(going(tmp_path, SWALLOWS, *words))
    assert ended.code == 130, ended
    assert len(mars2d.load(tmp_path / "kept.mcap")) == 20


@linux
def test_code_in_c_is_ended_by_a_second_ctrl_c_and_its_log_is_kept(tmp_path):
    words = ("run", "law.py", "--headless", "--record", "kept.mcap")
    command = going(tmp_path, IN_C, *words)
    ended = pressed_until_it_ends(command)
    assert ended.code == -signal.SIGKILL
    assert ended.err.startswith("mars2d: ended by force: code in C did not let it save")
    assert len(mars2d.load(tmp_path / "kept.mcap")) == 20
    assert command.left() == []


@linux
def test_whoever_looks_on_ends_with_the_command(tmp_path):
    command = going(tmp_path, NOTHING)
    assert len(command.left(patience=0)) == 2  # the command, and who looks on
    command.kill()
    assert command.end(PATIENCE).code == -signal.SIGKILL
    assert command.left() == []


def test_a_thread_that_goes_on_does_not_hold_the_command(tmp_path):
    experiment(tmp_path, THREAD, stop=3)
    ended = started(tmp_path, "run", "law.py", "--headless", "--record", "kept.npz").end(PATIENCE)
    assert ended.code == 0, ended
    assert "mars2d: left 1 thread that did not end: mine\n" in ended.err
    assert "record: kept.npz" in ended.out
    assert mars2d.load(tmp_path / "kept.npz").finished


@linux
@pytest.mark.slow
def test_a_process_that_goes_on_does_not_hold_the_command(tmp_path):
    experiment(tmp_path, PROCESS, stop=3)
    command = started(tmp_path, "run", "law.py", "--headless", "--record", "kept.npz")
    ended = command.end(PATIENCE)
    assert ended.code == 0, ended
    assert "mars2d: killed processes that did not end: mine\n" in ended.err
    assert "record: kept.npz" in ended.out
    assert command.left() == []


@linux
@pytest.mark.slow
def test_helpers_of_a_law_end_with_the_run(tmp_path):
    experiment(tmp_path, HELPERS, stop=3)
    command = started(tmp_path, "run", "law.py", "--headless", "--record", "kept.npz")
    ended = command.end(PATIENCE)
    assert ended.code == 0, ended
    assert ended.err.count("sleep") == 3
    assert "mars2d: killed processes that did not end: " in ended.err
    assert command.left() == []
    assert mars2d.load(tmp_path / "kept.npz").finished


@linux
@pytest.mark.slow
@pytest.mark.parametrize("then", ["", "        raise ValueError\n", "        while True: pass\n"])
def test_they_end_with_it_however_it_ends(tmp_path, then):
    command = going(tmp_path, HELPERS + then)
    if not then.endswith("Error\n"):
        os.kill(command.pid, signal.SIGTERM)
    assert command.end(PATIENCE).code == (2 if then.endswith("Error\n") else 130)
    assert command.left() == []


@linux
@pytest.mark.slow
def test_they_end_with_a_run_that_is_ended_by_force(tmp_path):
    command = going(tmp_path, HELPERS + '        open("helped", "w").close()\n' + IN_C)
    wait_until((tmp_path / "helped").exists)
    assert pressed_until_it_ends(command).code == -signal.SIGKILL
    assert command.left() == []


@linux
@pytest.mark.slow
def test_helpers_that_end_by_themselves_are_waited_for_and_not_mentioned(tmp_path):
    body = '        __import__("subprocess").Popen(["sh", "-c", "sleep 0.5; echo done > helped"])\n'
    experiment(tmp_path, body, stop=2.5)
    ended = started(tmp_path, "run", "law.py", "--headless").end(PATIENCE)
    assert (ended.code, ended.err) == (0, "")
    assert (tmp_path / "helped").exists()


SIGNALS = ["SIGTERM", "SIGUSR1", "SIGUSR2", "SIGXCPU"]


@pytest.mark.skipif(sys.platform == "win32", reason="has no such signals")
@pytest.mark.parametrize("name", SIGNALS)
def test_a_signal_ends_a_run_and_saves_it(tmp_path, name):
    command = going(tmp_path, NOTHING)
    os.kill(command.pid, getattr(signal, name))
    ended = command.end(PATIENCE)
    assert ended.code == 130, ended
    assert ended.err.endswith("mars2d: interrupted\n")
    assert "Traceback" not in ended.err
    assert len(mars2d.load(tmp_path / "kept.npz")) > 10


# -- standard files -------------------------------------------------------------------------------

CLOSED = {"stdin": "<&-", "stdout": ">&-", "stderr": "2>&-", "all": "<&- >&- 2>&-"}
FULL = {"full stdout": ">/dev/full", "full stderr": "2>/dev/full"}


@linux
@pytest.mark.parametrize("to", [*CLOSED.values(), *FULL.values()], ids=[*CLOSED, *FULL])
@pytest.mark.parametrize("kind", ["npz", "mcap", "csv"])
def test_a_standard_file_that_is_closed_or_full_costs_no_record(tmp_path, to, kind):
    experiment(tmp_path, NOTHING, stop=3)
    line = f"{sys.executable} -m mars2d run law.py --headless --record kept.{kind} {to}"
    done = subprocess.run(
        ["sh", "-c", line], cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE,
        check=False,
    )  # fmt: skip
    assert done.returncode == (2 if to == ">/dev/full" else 0), done
    assert "fault of MARS2D" not in done.stderr
    assert "Traceback" not in done.stderr
    assert len(mars2d.load(tmp_path / f"kept.{kind}")) == 31


@linux
@pytest.mark.parametrize("to", [*CLOSED.values(), *FULL.values()], ids=[*CLOSED, *FULL])
def test_a_law_that_fails_then_keeps_its_record_too(tmp_path, to):
    experiment(tmp_path, "        raise ValueError\n", stop=3)
    line = f"{sys.executable} -m mars2d run law.py --headless --record kept.npz {to}"
    done = subprocess.run(
        ["sh", "-c", line], cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE,
        check=False,
    )  # fmt: skip
    assert done.returncode == 2, done
    assert "fault of MARS2D" not in done.stderr + done.stdout
    assert len(mars2d.load(tmp_path / "kept.npz")) == 20


# -- studies --------------------------------------------------------------------------------------


@linux
def test_a_worker_in_code_in_c_is_ended_at_the_limit(tmp_path):
    (tmp_path / "law.py").write_text(
        HEAD.replace("STOP", "3").replace("scenario = ", "def scenario(hang=0):\n    return ")
        .replace("world.iteration == 20", "world.scenario.title == 'hang'")
        .replace("Scenario(", "Scenario(title='hang' if hang == 1 else 'go', ")
        + IN_C + "    return 0, 0\n"
    )  # fmt: skip
    command = started(
        tmp_path, "sweep", "law.py", "--set", "hang=0,1,2", "--seeds", "2", "--out", "s.csv",
        "--time-limit", "1", "--workers", "2",
    )  # fmt: skip
    ended = command.end(PATIENCE)
    assert ended.code == 0, ended
    errors = [row.error for row in load_table(tmp_path / "s.csv").results]
    assert [bool(error) for error in errors] == [False, False, True, True, False, False]
    assert "took longer than 1 s, in code that nothing interrupts" in errors[2]
    assert command.left() == []


@linux
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_workers_in_code_in_c_end_with_the_study(tmp_path, number):
    words = ("sweep", "law.py", "--seeds", "3", "--workers", "2", "--out", "s.csv")
    command = going(tmp_path, IN_C, *words)
    os.kill(command.pid, number)
    assert command.end(PATIENCE).code == (130 if number != signal.SIGKILL else -number)
    assert command.left() == []
