"""Odd orders before the window: to look back while one pulls, to draw in the past, and the like."""

import os

import pytest

from tests.cases import each_case

ROOM = """
from mars2d import Robot, Scenario
from mars2d.addons.base import Addon


def law(robot):
    count = 0
    while True:
        count += 1
        robot.memory.count = count
        yield 0.2, 0.01 * (count % 7)


class Lines(Addon):
    pass


scenario = Scenario(
    robots=[Robot(name="red", pose=(-2, 0, 0), controller=law), Robot(pose=(0, -1, 0))],
    workspace=[(-3, -2), (3, -2), (3, 2), (-3, 2)],
    addons=[Lines()],
    stop_time=4.0,
)
"""


@pytest.fixture
def sit(open_window, tmp_path):
    """Return a function that sits down before the window of a text."""

    def down(text=ROOM):
        path = tmp_path / "room.py"
        path.write_text(text)
        return open_window(1, experiment=path, folder=tmp_path)

    return down


def where(window):
    return window.state["row"], window.state["newest"], window.state["branches"]


def drag(window, robot, by, drop=True):
    x, y = window.pixel(*window.state["robots"][robot][:2])
    window.slide((x, y), (x + by[0], y + by[1]), drop=drop)


def save(window, path, text):
    """Save the experiment's file, as if a second later, and wait until it was read again."""
    stamp = path.stat().st_mtime_ns + 10**9
    path.write_text(text)
    os.utime(path, ns=(stamp, stamp))
    window.do("sleep", 2)


@each_case("key", ["Left", "Home"])
def test_to_look_back_while_pulling_lets_go_and_makes_no_branch(sit, key):
    window = sit()
    window.until(lambda s: s["row"] == 12)
    drag(window, 0, (0, -80), drop=False)
    window.until(lambda s: s["pulls"] == 1)
    window.press(key)
    assert window.state["row"] < window.state["newest"]
    assert window.state["pulls"] == 0
    newest = window.state["newest"]
    window.do("mouseup", 1)
    assert where(window)[1:] == (newest, 0)


def test_what_an_add_on_draws_of_theory_may_fail(sit, tmp_path):
    text = ROOM.replace(
        "    pass", "    def theory(self, scene, frame):\n        1 / (frame.time < 1)"
    )
    window = sit(text)
    window.press("y")
    banner = window.until(lambda s: s["banner"])
    assert "room.py, line 16: add-on 'lines' raised ZeroDivisionError" in banner["banner"]
    assert banner["line"] == 16
    window.press("p")
    assert (tmp_path / "room_1.png").exists()
    window.press("Left")
    assert window.state["banner"] is None
    window.press("End", "y", "r")
    assert window.settle()["banner"] is None


# -- errors ---------------------------------------------------------------------------------------

BAD = """
class Lines(Addon):
    pass


class Bad(Sensor):
    def read(self, *_):
        return 1 / 0
"""
SENSED = ROOM.replace("class Lines(Addon):\n    pass\n", BAD).replace(
    "controller=law", "controller=law, sensors=[Bad()]"
)
SENSED = SENSED.replace("\nfrom", "\nfrom mars2d.sensors import Sensor\nfrom", 1)


def test_a_sensor_that_fails_at_the_start_is_told_of_in_the_window_and_mended(sit, tmp_path):
    window = sit(SENSED)
    assert "sensor 'bad' raised ZeroDivisionError" in window.state["banner"]
    assert window.state["line"] is not None
    save(window, tmp_path / "room.py", ROOM)
    assert window.state["banner"] is None
    window.until(lambda s: s["row"] >= 5)
    save(window, tmp_path / "room.py", SENSED)
    assert window.state["line"] is not None


def test_a_mistake_that_is_mended_is_not_told_of_any_more(sit, tmp_path):
    window = sit()
    save(window, tmp_path / "room.py", ROOM.replace("while True:", "while True"))
    assert any("line 8" in note for note in window.state["notes"])
    save(window, tmp_path / "room.py", ROOM.replace("0.2, ", "0.3, "))
    assert window.state["notes"] == ["room.py: in effect from now on; R runs it from the start"]
