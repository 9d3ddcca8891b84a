"""How the window looks: pictures of it that were looked at, kept in references/.

`MARS2D_REFERENCES=new pytest tests/window/test_window_looks.py` takes new ones: look at them.
"""

import pytest

from tests.window.person import ROOM, compare

ACROSS = 300, 30
"""A pixel where the pointer changes nothing."""


def test_running_in_the_light(open_window):
    window = open_window(0.1, experiment="coverage_circle")
    window.do("mousemove", *ACROSS)
    window.press("Home")
    window.steps(40)
    window.until(lambda s: s["row"] == 40 and s["chip"] == "paused")
    window.press("space")
    window.until(lambda s: s["row"] > 40 and s["playing"])
    compare("window_running", window.look())


def test_paused_in_the_past_in_the_dark_with_another_branch(open_window, room):
    window = open_window(0, experiment=str(room), dark=True, silent=True)
    window.steps(60)
    window.until(lambda s: s["row"] == 60)
    window.steps(-45)
    window.until(lambda s: s["row"] == 15)
    window.drag((-2, -1), (-1, -1.5), (0, -1.2))
    window.until(lambda s: s["branches"] == 1)
    window.drag((-1.7, 0.5), (-1.5, -0.2), button=3)
    window.steps(40)
    window.until(lambda s: s["row"] == 55)
    window.steps(-10)
    window.until(lambda s: s["row"] == 45)
    window.do("mousemove", *ACROSS)
    compare("window_branch", window.still())


def test_the_help(open_window):
    window = open_window(0, experiment="wall_follower")
    window.do("mousemove", *ACROSS)
    window.press("F1")
    window.until(lambda s: s["help"] == 0)
    compare("window_help", window.still())


def test_the_inspector(open_window):
    window = open_window(0, experiment="wall_follower")
    window.do("mousemove", *ACROSS)
    window.steps(60)
    window.press("Tab")
    window.until(lambda s: (s["row"], s["selected"]) == (60, 0))
    compare("window_inspector", window.still())


def test_a_law_that_failed(open_window, room):
    law = "    if robot.pose[0] > -1:\n        speed = 1 / 0\n    return 0.2, 0.0"
    assert "    return 0.2, 0.0" in ROOM
    room.write_text(ROOM.replace("    return 0.2, 0.0", law))
    window = open_window("max", experiment=str(room))
    window.do("mousemove", *ACROSS)
    window.until(lambda s: s["status"] == "stopped")
    compare("window_error", window.still())


def test_driving_by_hand(open_window, room):
    window = open_window(0, experiment=str(room), silent=True)
    window.steps(40)
    window.press("Tab", "Tab", "h")
    window.until(lambda s: s["driving"] == 1 and s["row"] == 40)
    window.point(1, -1)
    window.until(lambda s: s["over_body"] == 2)
    compare("window_driving", window.look())


@pytest.mark.parametrize("pages", [False, True])
def test_for_the_back_row(open_window, pages):
    window = open_window(0, experiment="coverage_circle", text=1.7)
    window.do("mousemove", *ACROSS)
    window.steps(40)
    window.press(*["F1"] * pages)
    window.until(lambda s: s["row"] == 40 and s["help"] == (0 if pages else None))
    compare("window_large_help" if pages else "window_large", window.still())
