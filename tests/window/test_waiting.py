"""A law that does not return: the window is there, says where it waits, and answers."""

import signal

from tests.processes import PATIENCE
from tests.window.person import needs_screen

LAW = """\
from pathlib import Path

from mars2d import Robot, Scenario


def go(robot):
    while Path("hang").exists():
        v = 0.2
    return 0.3, 0


def scenario():
    return Scenario(robots=[Robot(name="red", controller=go)], stop_time=1000)
"""

WAITS = "waiting for hangs.py, line "


def waiting(open_window, folder, monkeypatch, patience="0"):
    """Open a window whose law hangs, and wait until it says so."""
    monkeypatch.setenv("MARS2D_PATIENCE", patience)
    path = folder / "hangs.py"
    path.write_text(LAW)
    window = open_window(1, experiment=str(path), folder=folder)
    (folder / "hang").touch()
    window.says(WAITS)
    return window


@needs_screen
def test_escape_leaves(open_window, tmp_path, monkeypatch):
    window = waiting(open_window, tmp_path, monkeypatch)
    window.press("Escape")
    assert window.process.wait(PATIENCE) is not None


@needs_screen
def test_its_close_button_leaves(open_window, tmp_path, monkeypatch):
    window = waiting(open_window, tmp_path, monkeypatch)
    window.ask_to_close()
    assert window.process.wait(PATIENCE) is not None


@needs_screen
def test_ctrl_c_leaves(open_window, tmp_path, monkeypatch):
    window = waiting(open_window, tmp_path, monkeypatch)
    window.process.send_signal(signal.SIGINT)
    assert window.process.wait(PATIENCE) is not None


@needs_screen
def test_a_mended_file_goes_on(open_window, tmp_path, monkeypatch):
    window = waiting(open_window, tmp_path, monkeypatch)
    reached = window.state["time"]
    (tmp_path / "hangs.py").write_text(LAW.replace("hang", "nothing"))
    window.until(lambda s: s["time"] > reached + 0.5 and s["banner"] is None)


@needs_screen
def test_after_its_patience_the_banner_names_line_robot_and_time(
    open_window, tmp_path, monkeypatch
):
    window = waiting(open_window, tmp_path, monkeypatch, patience="1")
    state = window.until(lambda s: s["banner"])
    assert "go did not return within 1 s" in state["banner"]
    assert state["line"] in {7, 8}


@needs_screen
def test_keys_pressed_meanwhile_are_done_afterwards(open_window, tmp_path, monkeypatch):
    window = waiting(open_window, tmp_path, monkeypatch)
    before = window.state["layers"]["grid"]
    window.press("g")
    (tmp_path / "hangs.py").write_text(LAW.replace("hang", "nothing"))
    window.until(lambda s: s["layers"]["grid"] != before and s["banner"] is None)
    window.press("g")  # it is not taken for one that is still held
    window.until(lambda s: s["layers"]["grid"] == before)
