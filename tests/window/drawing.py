"""The person who draws: an editor in a process of its own, and the hands and eyes before it."""

import json

import numpy as np
import pytest

from mars2d.scenario import save_scenario
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from tests.window.person import Driver


class Hands(Driver):
    """The editor in a process of its own, and the hands and eyes of the person before it."""

    def __init__(self, screen, folder, source="-", **options):
        self._sit(
            screen, "observed_editor", source, json.dumps(options), folder=folder, shows="tool"
        )

    def pixel(self, x, y):
        """Return the pixel of a point in metres."""
        (left, top), scale = self.state["origin"], self.state["scale"]
        return round(left + scale * x), round(top - scale * y)

    def point(self, x, y):
        self.do("mousemove", *self.pixel(x, y))

    def click(self, x, y, button=1):
        self.do("mousemove", *self.pixel(x, y), "click", button)

    def drag(self, *places, button=1, drop=True):
        """Drag through points in metres."""
        first, *others = (self.pixel(*place) for place in places)
        moves = [word for place in others for word in ("mousemove", *place, "sleep", 0.03)]
        self.do("mousemove", *first, "mousedown", button, "sleep", 0.03, *moves)
        if drop:
            self.do("mouseup", button)

    def tool(self, letter, name):
        self.press(letter)
        self.until(lambda s: s["tool"] == name)

    def row(self, title):
        """Click a row of the panel."""
        self.until(lambda s: title in s["panel"])
        self.do("mousemove", *self.state["panel"][title], "click", 1)

    def sign(self, sign, title):
        """Click + or - in a row of the panel."""
        self.do("mousemove", *self.state["signs"][f"{sign} {title}"], "click", 1)

    def entry(self, title):
        """Click an entry of the open menu."""
        self.until(lambda s: title in s["menu"])
        self.do("mousemove", *self.state["menu"][title], "click", 1)

    def fill(self, text):
        """Type over the field of the open prompt, and press Enter."""
        self.until(lambda s: s["prompt"] is not None)
        for _ in self.state["typed"]:
            self.press("BackSpace")
        self.type(text)
        self.press("Return")
        self.until(lambda s: s["prompt"] is None or s["error"])

    def type(self, text):
        self.do("type", "--delay", "15", "--", text)


@pytest.fixture
def open_editor(screen, tmp_path):
    """Return a function that opens an editor; all are closed at the end."""
    opened = []

    def start(source="-", **options):
        if isinstance(source, Scenario):
            save_scenario(source, tmp_path / "given.toml")
            source = tmp_path / "given.toml"
        opened.append(Hands(screen, tmp_path, source, **options))
        return opened[-1]

    yield start
    for window in opened:
        window.close()


def team(*poses, **changes):
    return Scenario(robots=[Robot(pose=pose, diameter=0.6) for pose in poses], **changes)


def near(a, b, slack=0.011):
    return np.allclose(np.array(a, dtype=float), np.array(b, dtype=float), atol=slack)
