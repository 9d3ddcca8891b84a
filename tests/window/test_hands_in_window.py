"""Hands on a running world, with a real mouse and real keys in the real window."""

import time
from itertools import pairwise
from math import atan2, hypot

import pytest

from tests.cases import each_case
from tests.window.person import Driver, needs_screen

pytestmark = [needs_screen, pytest.mark.nightly]


class Person(Driver):
    """Somebody before a window that tells where everything is."""

    def __init__(self, screen, *arguments):
        self._sit(screen, "observed_hands", *arguments)

    def leave(self):
        """Let go of the mouse, and close the window."""
        self.do("mouseup", 1, "mouseup", 3)
        self.close()

    def later(self, seconds):
        """Return the state once the run has gone on for some seconds of its own time."""
        now = self.settle()["time"]
        return self.until(lambda s: s["time"] > now + seconds)

    def to(self, x, y):
        """Move the pointer to a point of the world."""
        scale, left, top = self.state["camera"]
        self.do("mousemove", round(left + scale * x), round(top - scale * y))
        time.sleep(0.05)

    def drag(self, *points, button=1):
        """Drag along points of the world, and hold on at the last."""
        self.to(*points[0])
        self.do("mousedown", button)
        for a, b in pairwise(points):
            self.to((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
            self.to(*b)


@pytest.fixture
def sit(screen):
    """Sit down before a window; it is closed afterwards."""
    people = []

    def down(*arguments):
        people.append(Person(screen, *arguments))
        return people[-1]

    yield down
    for person in people:
        person.leave()


def test_while_time_passes_a_drag_pulls_and_time_goes_on_as_before(sit):
    person = sit(1.0)
    person.to(-2, -1)
    assert person.until(lambda s: s["over"] == 1)
    before = person.settle()
    person.drag((-2, -1), (-1.0, -1.5))
    person.until(lambda s: s["pulls"] == 1)
    for k in range(20):
        person.to(-1.0 + 0.02 * k, -1.5)
    x, y = -1.0 + 0.02 * 19, -1.5
    person.until(lambda s: hypot(s["robots"][1][0] - x, s["robots"][1][1] - y) < 0.08)
    after = person.settle()
    gone = after["time"] - before["time"]
    assert gone == pytest.approx(after["passed"] - before["passed"], abs=0.2)
    person.do("mouseup", 1)
    assert person.until(lambda s: s["pulls"] == 0 and not s["busy"])


def test_a_click_selects_and_pulls_nothing(sit):
    person = sit(1.0)
    person.to(-2, 1)
    person.do("click", 1)
    person.until(lambda s: s["selected"] == 2)
    assert person.settle()["pulls"] == 0


def test_while_it_stands_still_a_drag_puts_a_crate_elsewhere_and_a_right_drag_turns_it(sit):
    person = sit(1.0)
    person.do("key", "space")
    person.until(lambda s: s["paused"])
    person.drag((-2, 1), (-1, 0.5))
    person.until(lambda s: hypot(s["props"][0][0] + 1, s["props"][0][1] - 0.5) < 0.03)
    person.do("mouseup", 1)
    x, y, _ = person.settle()["props"][0]
    assert (x, y) == pytest.approx((-1, 0.5), abs=0.03)
    person.drag((x, y), (x + 1, y + 0.5), button=3)
    person.do("mouseup", 3)
    turned = person.settle()["props"][0][2]
    assert turned == pytest.approx(atan2(0.5, 1.0), abs=0.03)


def test_put_into_another_it_springs_back(sit):
    person = sit(1.0)
    person.do("key", "space")
    person.until(lambda s: s["paused"])
    person.drag((-2, 1), (-2, -0.9))
    person.do("mouseup", 1)
    assert person.settle()["props"][0] == [-2, 1, 0]


def test_put_elsewhere_in_the_past_another_branch_begins(sit):
    person = sit(5.0)
    person.until(lambda s: s["time"] > 3)
    person.do("key", "Home")
    person.until(lambda s: s["past"] and s["time"] == 0)
    person.drag((-2, 1), (-1, 0.5))
    person.do("mouseup", 1)
    person.until(lambda s: s["branches"] == 1 and not s["past"])
    assert person.settle()["props"][0][:2] == pytest.approx((-1, 0.5), abs=0.03)


@each_case("key", ["Up", "w"])
def test_keys_drive_a_robot_that_waits_for_its_driver(sit, key):
    person = sit(1.0, 1)
    assert person.state["paused"]
    assert person.state["driving"] == 1
    person.do("key", "space")
    person.until(lambda s: not s["paused"])
    person.do("keydown", key)
    person.until(lambda s: s["robots"][1][0] > -1.6)
    person.do("keyup", key)
    there = person.later(0.5)["robots"][1]
    assert person.later(0.5)["robots"][1] == there  # it stands
    assert there[1:] == [-1, 0]
    person.do("keydown", "Left" if key == "Up" else "a")
    person.until(lambda s: s["robots"][1][2] > 0.5)
    person.do("keyup", "Left" if key == "Up" else "a")


def test_h_drives_the_selected_robot_and_gives_it_back_to_its_law(sit):
    person = sit(1.0)
    person.do("key", "Tab")
    person.until(lambda s: s["selected"] == 0)
    person.do("key", "h")
    person.until(lambda s: s["driving"] == 0 and s["status"] == "driving red")
    there = person.later(0.5)["robots"][0]
    assert person.later(0.5)["robots"][0] == there  # it waits for keys
    person.do("key", "h")
    person.until(lambda s: s["driving"] is None)
    person.until(lambda s: s["robots"][0][0] > there[0] + 0.1)
