"""A display that is not there, a terminal that is closed, a reader that stops reading."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mars2d.scenario import save_scenario
from mars2d.scenario.experiment import open_experiment
from mars2d.world.record import load
from tests.processes import PATIENCE, bare_environment, begun, mars
from tests.window.person import ROOM

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gone")
    (folder / "room.py").write_text(ROOM)
    save_scenario(open_experiment(folder / "room.py").scenario, folder / "drawn.toml")
    short = ["run", "room.py", "--headless", "--stop-time", "5", "--record", "past.npz"]
    assert mars(*short, cwd=folder).returncode == 0
    return folder


WAYLAND = "error: XDG_RUNTIME_DIR is invalid or not set in the environment.\n"
"""What Wayland's own library says where there is no desktop at all."""

ABSENT = """
import sys
from mars2d.cli.command_line import main
for command in sys.argv[1:]:
    print(main(command.split()), flush=True)
    print(file=sys.stderr, flush=True)
"""


@pytest.mark.nightly
def test_a_display_that_is_not_there_is_said_in_one_line(folder):
    commands = "replay past.npz", "edit drawn.toml", "run room.py --speed 0", "run room.py --json"
    done = subprocess.run(
        [sys.executable, "-c", ABSENT, *commands],
        cwd=folder,
        env=bare_environment(PYTHONPATH=str(ROOT), DISPLAY=":987"),
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    codes = [line for line in done.stdout.splitlines() if len(line) == 1]
    said = done.stderr.replace(WAYLAND, "").split("\n\n")
    replay, edit, run, headless = said[:4]
    assert codes == ["2", "2", "2", "0"]
    assert replay.startswith("mars2d: there is no display for a window; make a film with --video")
    assert edit.startswith("mars2d: there is no display to draw on")
    assert run.startswith("mars2d: --speed 0 makes one step a key press")
    assert headless.startswith("mars2d: there is no display, so this runs without a window")
    assert [part.count("\n") for part in (replay, edit, run)] == [0, 0, 0]


@pytest.mark.nightly
@pytest.mark.skipif(sys.platform == "win32", reason="no such terminals")
def test_a_run_whose_terminal_is_closed_is_saved(folder):
    ours, theirs = os.openpty()
    environment = bare_environment(PYTHONPATH=str(ROOT))
    take = "import os, sys; os.setsid(); os.close(os.open(os.ttyname(0), os.O_RDWR))"
    run = "sys.exit(__import__('mars2d.cli.command_line').cli.main(sys.argv[1:]))"
    long = ["run", "room.py", "--headless", "--stop-time", "1e5", "--record", "closed.npz"]
    process = subprocess.Popen(
        [sys.executable, "-c", f"{take}\n{run}", *long],
        cwd=folder, env=environment, stdin=theirs, stdout=theirs, stderr=theirs,
    )  # fmt: skip
    os.close(theirs)
    said = b""
    while b"steps/s" not in said:
        said += os.read(ours, 1000)
    os.close(ours)
    assert process.wait(PATIENCE) == 130
    assert len(load(folder / "closed.npz")) > 1


def test_whoever_reads_may_stop_reading(folder):
    with begun("list", cwd=folder) as process:
        process.stdout.close()
        assert (process.stderr.read(), process.wait()) == ("", 0)
