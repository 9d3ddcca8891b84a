"""A display or a terminal that is not there, or goes away while a window is open."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from mars2d.record.record import load
from mars2d.scenario import save_scenario
from mars2d.scenario.experiment import open_experiment
from tests.processes import PATIENCE, bare_environment, wait_until, x_server
from tests.window.person import ROOM, needs_screen

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
GONE = "mars2d: the display has gone away that the window was on\n"


def mars(folder, *arguments, **environment):
    """Start a command line in a folder."""
    return subprocess.Popen(
        [sys.executable, "-m", "mars2d", *arguments],
        cwd=folder,
        env=bare_environment(PYTHONPATH=str(ROOT), **environment),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def windows_on(display):
    """Return how many windows are seen."""
    search = ["xdotool", "search", "--onlyvisible", "--class", "."]
    environment = bare_environment(DISPLAY=display)
    told = subprocess.run(search, env=environment, capture_output=True, check=False)
    return len(told.stdout.split())


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gone")
    (folder / "room.py").write_text(ROOM)
    scenario = open_experiment(folder / "room.py").scenario
    save_scenario(scenario.replace(robots=scenario.robots[1:]), folder / "drawn.toml")
    short = ["run", "room.py", "--headless", "--stop-time", "5", "--record", "past.npz"]
    process = mars(folder, *short)
    process.communicate(timeout=PATIENCE)
    assert process.returncode == 0
    return folder


@pytest.fixture(scope="module")
def left(folder):
    """Kill the X server under windows of all kinds; return how each ended, and what it said."""
    commands = {
        "npz": ["run", "room.py", "--record", "live.npz", "--speed", "1"],
        "mcap": ["run", "room.py", "--record", "live.mcap", "--speed", "1"],
        "replay": ["replay", "past.npz"],
        "editor": ["edit", "drawn.toml", "--set", "title=Another room"],
    }
    with x_server() as (display, server):
        processes = {
            name: mars(folder, *command, DISPLAY=display) for name, command in commands.items()
        }
        try:
            wait_until(lambda: windows_on(display) == len(commands))
            wait_until((folder / "live.mcap").exists)
            time.sleep(1.0)  # there is something to lose by then
            server.kill()
            said = {name: each.communicate(timeout=PATIENCE) for name, each in processes.items()}
        finally:
            for process in processes.values():
                process.kill()
                process.wait(PATIENCE)
    return {name: (processes[name].returncode, *said[name]) for name in commands}


@needs_screen
@pytest.mark.parametrize("suffix", ["npz", "mcap"])
def test_a_run_whose_display_goes_away_keeps_what_was_recorded(folder, left, suffix):
    code, out, said = left[suffix]
    record = load(folder / f"live.{suffix}")
    assert (code, out) == (2, "")
    kept = f"what was recorded until {record.time[-1]:g} s is in live.{suffix}"
    assert said == f"mars2d: {kept}\n{GONE}"
    assert len(record) > 1


@needs_screen
def test_a_replay_whose_display_goes_away_ends_in_one_line(left):
    assert left["replay"] == (2, "", GONE)


@needs_screen
def test_what_was_drawn_is_kept_when_the_display_goes_away(folder, left):
    path = folder / "drawn_unsaved_1.toml"
    kept = f"mars2d: what was drawn and not saved is in {path}\n"
    assert left["editor"] == (2, "", kept + GONE)
    scenario = open_experiment(path).scenario
    assert scenario.title == "Another room"
    assert open_experiment(folder / "drawn.toml").scenario.title == "A room"


WAYLAND = "error: XDG_RUNTIME_DIR is invalid or not set in the environment.\n"
"""What Wayland's own library says where there is no desktop at all."""

ABSENT = """
import sys
from mars2d.cli.command_line import main
for command in sys.argv[1:]:
    print(main(command.split()), flush=True)
    print(file=sys.stderr, flush=True)
"""


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


@pytest.mark.parametrize("command", ["list", "run room.py --headless --json --stop-time 1"])
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_whoever_reads_may_stop_reading(folder, command, unbuffered):
    process = mars(folder, *command.split(), PYTHONUNBUFFERED=unbuffered)
    process.stdout.close()
    assert (process.stderr.read(), process.wait(PATIENCE)) == ("", 0)
    process.stderr.close()
