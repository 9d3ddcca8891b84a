"""Commands that open a window, on a real screen, with real keys: what only these can show."""

import json
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pygame
import pytest

from mars2d.cli import command_line as cli
from mars2d.scenario import load_scenario
from mars2d.window.screen.display import display_available
from mars2d.world.record import load
from tests.processes import HIDDEN, PATIENCE, bare_environment, wait_until

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]

WALKS = """
'Walks. Question: how far does it get? Try: another speed.'
from pathlib import Path

from mars2d import Robot, Scenario


def go(robot):
    if robot.time > 0.5:
        Path("walks").touch()
    while robot.time > 1 and Path("hang").exists():
        Path("hangs").touch()
    return 0.3, 0


scenario = Scenario(title="Walks", robots=[Robot(controller=go)], stop_time=1000)
"""
"""A law that tells when it goes, and when it does not return, as it is told to."""


class Command:
    """A Python process that opens windows, and the person before them."""

    def __init__(self, screen, folder, *words, **environment):
        self.environment = bare_environment(
            DISPLAY=screen, SDL_VIDEO_WINDOW_POS="0,0", PYTHONPATH=str(ROOT), **environment
        )
        self.process = subprocess.Popen(
            [sys.executable, *map(str, words)], env=self.environment, cwd=folder, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip

    def do(self, *words):
        done = subprocess.run(
            ["xdotool", *map(str, words)], env=self.environment, capture_output=True, text=True,
            check=False,
        )  # fmt: skip
        return done.stdout.split()

    def wait_for(self, title):
        """Wait until the window of this title has the keyboard."""
        focused = ["getwindowfocus", "getwindowname"]
        wait_until(lambda: self.do(*focused) == title.split(), self.process)

    def press(self, *keys):
        self.do("key", "--delay", 100, *keys)

    def end(self):
        """Wait until it has ended by itself; return the exit code and what was printed."""
        out, errors = self.process.communicate(timeout=PATIENCE)
        return self.process.returncode, out + errors


@pytest.fixture
def command(screen):
    """Return what starts a command; all are killed at the end."""
    opened = []

    def start(folder, *words, **environment):
        opened.append(Command(screen, folder, *words, **environment))
        return opened[-1]

    yield start
    for each in opened:
        each.process.kill()
        each.process.communicate()


def test_run_lets_a_person_drive_and_keeps_what_was_run_and_replay_shows_it(
    command, room, tmp_path
):
    words = ["run", room, "--human", "blue", "--dark", "--text", "1.7", "--record", "out.npz"]
    seen = command(tmp_path, "-m", "mars2d", *words)
    seen.wait_for("A room - MARS2D")
    seen.press("p")
    wait_until((tmp_path / "room_1.png").exists, seen.process)
    seen.press("space")
    seen.do("keydown", "Up", "sleep", 1, "keyup", "Up")
    seen.press("ctrl+q")
    code, told = seen.end()
    assert code == 0, told
    assert "A room" in told
    record = load(tmp_path / "out.npz")
    assert record.pose[-1, 0, 1] > -1.9  # blue, which has no law
    assert record.pose[-1, 0, 0] > -1.95  # red, by its law
    replayed = command(tmp_path, "-m", "mars2d", "replay", "out.npz", "--speed", "max")
    replayed.wait_for("A room - MARS2D")
    replayed.press("End", "p")
    wait_until((tmp_path / "a_room_1.png").exists, replayed.process)
    replayed.press("Home", "ctrl+q")
    assert replayed.end()[0] == 0


@pytest.fixture
def walks(tmp_path):
    (tmp_path / "walks.py").write_text(WALKS)
    return ["-m", "mars2d", "run", "walks.py", "--record", "out.npz"]


def test_a_window_at_rest_takes_hardly_any_time_and_ctrl_c_keeps_the_record(
    command, walks, tmp_path
):
    seen = command(tmp_path, *walks)
    wait_until((tmp_path / "walks").exists, seen.process)
    seen.press("space")
    process = psutil.Process(seen.process.pid)

    def rests():
        before = sum(process.cpu_times()[:2])
        seen.do("sleep", 1)
        return sum(process.cpu_times()[:2]) - before < 0.15

    wait_until(rests, seen.process)
    seen.process.send_signal(signal.SIGINT)
    code, told = seen.end()
    assert code == 130
    assert "Question: How far does it get?\nTry: Another speed.\n" in told
    assert not load(tmp_path / "out.npz").finished


def test_a_law_that_does_not_return_leaves_the_window_to_ctrl_q(command, walks, tmp_path):
    (tmp_path / "hang").touch()
    seen = command(tmp_path, *walks, MARS2D_PATIENCE="0")
    wait_until((tmp_path / "hangs").exists, seen.process)
    wait_until(lambda: (seen.press("ctrl+q"), seen.process.poll() is not None)[1])
    code, told = seen.end()
    assert code != 0
    assert "go did not return before the window was closed" in told
    assert len(load(tmp_path / "out.npz")) > 0


def test_compare_opens_a_window_and_prints_the_table(command, tmp_path):
    seen = command(tmp_path, "-m", "mars2d", "compare", "push_box", "--stop-time", "1000")
    wait_until(lambda: (seen.press("ctrl+q"), seen.process.poll() is not None)[1])
    code, told = seen.end()
    assert code == 0
    assert "physics" in told
    assert "The window was closed" in told
    assert not list(tmp_path.iterdir()), "neither picture nor film"


def test_edit_draws_a_new_file(command, tmp_path):
    seen = command(tmp_path, "-m", "mars2d", "edit", "room.toml")
    wait_until(lambda: "MARS2D" in seen.do("getwindowfocus", "getwindowname"), seen.process)
    seen.do("key", "r", "mousemove", 600, 350, "click", 1, "sleep", 0.2)
    seen.press("ctrl+s", "Return")
    wait_until((tmp_path / "room.toml").exists)
    seen.press("ctrl+q")
    code, told = seen.end()
    assert code == 0, told
    assert len(load_scenario(tmp_path / "room.toml").robots) == 1


def test_the_run_button_of_an_editor_opens_the_window(command, tmp_path):
    assert cli.main(["new", str(tmp_path / "my_walk")]) == 0
    seen = command(tmp_path, "my_walk.py")
    seen.wait_for("My walk - MARS2D")
    seen.press("ctrl+q")
    assert seen.end()[0] == 0


def test_from_the_home_to_an_own_file_and_back(command, tmp_path):
    """The home shows the mistake of a file; mended, it opens; its window closes to the home."""
    file = tmp_path / "walk.py"
    file.write_text("import mars2d\nscenario = mars2d.Scenario(title='Mine', sampling_time=-5)\n")
    folder = tmp_path / "memory"
    folder.mkdir()
    (folder / "windows.json").write_text(json.dumps({"recent": [str(file)], "size": [900, 600]}))
    home = command(tmp_path, "-m", "mars2d", MARS2D_MEMORY=str(folder))
    home.do("mousemove", 0, 0)  # a pointer that a window opens under chooses a card
    home.wait_for("MARS2D")
    home.press("Right", "Return")
    assert "sampling_time" in home.process.stderr.readline()
    file.write_text("import mars2d\nscenario = mars2d.Scenario(title='Mine')\n")
    home.wait_for("MARS2D")
    home.press("Right", "Return")
    home.wait_for("Mine - MARS2D")
    home.press("d", "ctrl+q")
    home.wait_for("MARS2D")
    home.press("ctrl+q")
    assert home.end()[0] == 0
    kept = json.loads((folder / "windows.json").read_text())
    assert kept["dark"]
    assert kept["recent"] == [str(file)]
    assert len(list(folder.glob("*.png"))) == 1


def test_a_display_is_found(monkeypatch, screen):
    for name in HIDDEN:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("DISPLAY", screen)
    assert display_available()
    pygame.display.quit()  # it is kept for the window that follows
