"""Ctrl-C at the wrong moment: one line, exit code 130, and what is being saved is whole."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import mars2d
from tests.faults.test_disk import LAW
from tests.processes import PATIENCE, begun, wait_until

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX"),
]


@pytest.mark.skipif(sys.platform != "linux", reason="libraries are looked for in /proc")
def test_ctrl_c_while_the_libraries_are_imported_is_one_line() -> None:
    with begun("list") as process:
        maps = Path(f"/proc/{process.pid}/maps")
        wait_until(lambda: "numpy" in maps.read_text(), process)
        process.send_signal(2)
        _, errors = process.communicate()
    assert (process.returncode, errors) in ((130, "mars2d: interrupted\n"), (0, ""))


IN_THE_MIDST = """
import os, signal
import mars2d.cli.command_line
from mars2d.output.formats import npz

def slowly(record, path):
    os.kill(os.getpid(), signal.SIGINT)
    os.kill(os.getpid(), signal.SIGINT)
    write(record, path)

write, npz.write = npz.write, slowly
"""


def test_ctrl_c_while_a_run_is_saved_waits_for_that(tmp_path, child) -> None:
    (tmp_path / "law.py").write_text(LAW)
    words = ["run", str(tmp_path / "law.py"), "--headless", "--record", str(tmp_path / "out.npz")]
    done = child(f"{IN_THE_MIDST}\nraise SystemExit(mars2d.cli.command_line.main({words!r}))")
    assert done.returncode == 130
    assert done.stderr.startswith("mars2d: one moment: the run is being saved in ")
    assert done.stderr.endswith("out.npz\nmars2d: interrupted\n")
    assert mars2d.load(tmp_path / "out.npz").digest == mars2d.run(tmp_path / "law.py").digest


def test_in_python_too_a_run_is_saved_before_ctrl_c_comes_through(tmp_path, child) -> None:
    target = str(tmp_path / "a.npz")
    code = f"""{IN_THE_MIDST}
before = signal.getsignal(signal.SIGINT)
try:
    mars2d.run("random_walk", stop_time=5, record={target!r})
except KeyboardInterrupt:
    print(len(mars2d.load({target!r})), signal.getsignal(signal.SIGINT) is before)
"""
    assert child(code).stdout.split() == ["6", "True"]


def test_ctrl_c_while_a_row_is_logged_comes_when_it_is_written(tmp_path, child) -> None:
    pytest.importorskip("mcap")
    path = str(tmp_path / "run.mcap")
    code = f"""
import mars2d, os, signal
from mars2d import Scenario, World
from mars2d.output.formats.mcap import Log
from mars2d.output.formats.mcap.writing import Tape
begin = Tape.begin
def slowly(self, *args):
    os.kill(os.getpid(), signal.SIGINT)
    begin(self, *args)
Tape.begin = slowly
try:
    with Log({path!r}) as log:
        world = World(Scenario())
        while True:
            world.step([[0.1], [0.2]])
            log.follow(world)
except KeyboardInterrupt:
    print(world.iteration, len(mars2d.load({path!r})))
    print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)
"""
    assert child(code).stdout.split() == ["1", "1", "True"]


HALF = """
import os, signal, sys
from pathlib import Path
from mars2d.core.files import atomic_write

with atomic_write(Path(sys.argv[1])) as file:
    file.write(bytes(100_000))
    file.flush()
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_file_that_was_being_replaced_at_kill_9_stays_as_it_was(tmp_path) -> None:
    target = tmp_path / "run.csv"
    target.write_text("older")
    done = subprocess.run([sys.executable, "-c", HALF, target], timeout=PATIENCE, check=False)
    assert done.returncode == -9
    assert target.read_text() == "older"
