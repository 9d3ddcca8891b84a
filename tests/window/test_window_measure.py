"""What is measured by hand and read beside the run: ruler, stopwatch, printed lines, the source."""

import sys

import pytest

from mars2d.core.scene import Scene, Text
from mars2d.window.run.ending import command_for
from tests.cases import each_case
from tests.processes import wait_until
from tests.window.person import differing
from tests.window.test_window_buttons import choose

FAILING = """
from mars2d import Robot, Scenario


def go(robot):
    print("at", end=" row ")
    print(robot.world.iteration)
    return 0.1, 0.0 if robot.pose[0] < 0.02 else oops


def scenario():
    return Scenario(robots=[Robot(controller=go)], sampling_time=0.1)
"""


def length(window):
    """What the ruler says."""
    shown, scene = window.shown, Scene()
    shown.tools.ruler.draw(scene, shown.player.frame, shown.camera, None)
    return [shape.text for shape in scene.shapes if isinstance(shape, Text)]


def test_a_ruler_lies_between_points_and_bodies_and_moves_with_these(open_window, room):
    window = open_window(0, experiment=str(room))
    window.press("F8")
    window.click(0, 0)
    window.click(1.5, 2)
    (text,) = length(window)
    metres, degrees = text.rstrip("°").split(" m at ")
    assert (float(metres), float(degrees)) == pytest.approx((2.5, 53.1), rel=0.02)
    window.press("Escape")
    assert length(window) == []
    window.do("mousemove", 400, 590)  # over the footer
    window.press("Tab", "F8")
    before = window.still()
    window.do("mousemove", 500, 590)
    assert differing(before, window.still()) == 0, "only in the picture it goes to the pointer"
    window.press("Tab", "F8")  # from red to blue, by keys
    assert length(window) == ["1.500 m at \N{MINUS SIGN}90.0°"]
    window.press("Right")  # red goes ahead
    assert length(window) != ["1.500 m at \N{MINUS SIGN}90.0°"]
    window.press("F8")
    assert not window.shown.tools.ruler.on
    window.click(0, 0, button=3)
    choose(window, "Measure from here")
    assert window.shown.tools.ruler.ends[0] == pytest.approx((0, 0), abs=0.01)


def test_a_stopwatch_goes_with_the_time_of_the_run_also_backwards(open_window, room):
    window = open_window(0, experiment=str(room))
    watch = window.shown.tools.stopwatch
    window.press("Right", "Right", "F9", "Right", "Right", "Right")
    assert watch.words(window.shown.player.frame.time).startswith("0.300 s   from 0.200 s")
    window.press("Home")
    assert watch.words(window.shown.player.frame.time).startswith("\N{MINUS SIGN}0.200 s")
    window.press("End", "F9")
    assert watch.words(99.0) == "0.300 s   from 0.200 s to 0.500 s"
    window.click(0, 0, button=3)
    choose(window, "Stopwatch")
    assert watch.words(1.0) == ""


def test_what_a_law_prints_is_in_the_terminal_and_in_a_panel_the_last_line_first(
    open_window, tmp_path, capsys
):
    path = tmp_path / "walk.py"
    path.write_text(FAILING)
    window = open_window(0, experiment=str(path))
    printed = window.shown.dock.printed
    with printed.listening():
        window.press("Right", "Right")
        assert sys.stdout.isatty() in (True, False)  # it is the terminal in all else
    assert [round(time, 1) for time, _ in printed.lines] == [0.1, 0.0]
    assert all(text.startswith("at row ") for _, text in printed.lines)
    assert capsys.readouterr().out.count("at row ") == 2
    window.click(3, -3, button=3)
    choose(window, "Show what is printed")
    assert window.until(lambda s: "printed" in window.shown.dock.plates)
    window.press("F6")
    assert not printed.is_open


def test_an_error_opens_its_line_in_the_persons_own_editor(open_window, tmp_path, monkeypatch):
    path, seen = tmp_path / "walk.py", tmp_path / "seen"
    path.write_text(FAILING)
    editor = tmp_path / "editor.py"
    editor.write_text(f"import sys; open({str(seen)!r}, 'w').write(' '.join(sys.argv[1:]))")
    monkeypatch.setenv("VISUAL", f"{sys.executable} {editor}")
    window = open_window(0, experiment=str(path))
    window.press("Right", "Right", "Right", "Right")
    assert "F7 opens the file" in window.shown._ending.banner().hint
    window.do("mousemove", *window.shown.layout.footer.center, "click", 1)
    opened = window.shown._ending.editors
    wait_until(lambda: opened[-1].poll() is not None)
    assert seen.read_text() == f"+8 {path}"
    window.press("Home", "F7")  # where nothing has failed, at the top
    wait_until(lambda: opened[-1].poll() is not None)
    assert seen.read_text() == f"+1 {path}"
    monkeypatch.setenv("VISUAL", "no-such-editor")
    window.press("F7")
    window.says("no-such-editor can't be started")


@each_case(
    "variables, command",
    [
        ({"VISUAL": "code -w"}, ["code", "-w", "--goto", "a.py:7"]),
        ({"EDITOR": "/usr/bin/hx"}, ["/usr/bin/hx", "a.py:7"]),
        ({"VISUAL": "nano", "EDITOR": "vi"}, ["nano", "+7", "a.py"]),
        ({}, None),
    ],
)
def test_editors_are_told_the_line_as_each_wants_it(variables, command):
    with pytest.MonkeyPatch.context() as patch:
        for name in ("VISUAL", "EDITOR"):
            patch.delenv(name, raising=False)
        for name, value in variables.items():
            patch.setenv(name, value)
        found = command_for("a.py", 7)
    assert found == command or (command is None and found[-1] == "a.py")
