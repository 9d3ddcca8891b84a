"""How the window looks: pictures of it that were looked at, kept in references/.

`MARS2D_REFERENCES=new pytest tests/window/test_window_looks.py` takes new ones: look at them.
"""

import pytest

from tests.window.person import compare

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


@pytest.mark.parametrize("pages", [False, True])
def test_for_the_back_row(open_window, pages):
    window = open_window(0, experiment="coverage_circle", text=1.7)
    window.do("mousemove", *ACROSS)
    window.steps(40)
    window.press(*["F1"] * pages)
    window.until(lambda s: s["row"] == 40 and s["help"] == (0 if pages else None))
    compare("window_large_help" if pages else "window_large", window.still())
