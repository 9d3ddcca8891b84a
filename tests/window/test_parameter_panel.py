"""Parameters as sliders: the mouse drags them, keys move them, numbers are typed."""

from __future__ import annotations

from types import SimpleNamespace

import pygame
import pytest

from mars2d import Robot, Scenario, World
from mars2d.core.errors import InputError
from mars2d.output.raster.painter import Painter
from mars2d.scenario.experiment import open_experiment
from mars2d.window.panels.parameter_panel import LEAST_ROWS, ROW, ParameterPanel
from mars2d.window.screen.picking import Selection
from mars2d.world.timeline import Timeline
from tests.window.strokes import pressed

pytestmark = pytest.mark.usefixtures("keyboard")

FILE = """
from typing import Annotated
from mars2d import Range, Robot, Scenario
from mars2d.bodies import Box

def go(robot, speed: Annotated[float, Range(0, 0.4, unit="m/s")] = 0.1):
    return speed, 0.0

def scenario(mu: Annotated[float, Range(0.1, 1.1)] = 0.6, robots: Annotated[int, Range(1, 4)] = 2):
    red = Robot(friction=mu, controller=go)
    crate = Box(name="crate", pose=(2, 1, 0), mass=2.0)
    team = [red.replace(name=f"red{k}").at(-3, k - 1) for k in range(robots)]
    return Scenario(robots=team, props=[crate], stop_time=60.0)
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "team.py"
    path.write_text(FILE)
    return path


# -- without a screen -------------------------------------------------------------------------


class Desk:
    """A panel on a picture, whose time passes by hand."""

    def __init__(self, file, plays=True, cost=0.0):
        self.source = Timeline(open_experiment(file))
        self.now, self.set_to, self.cost, self.reason = 0.0, [], cost, ""
        self.player = SimpleNamespace(source=self.source, playing=plays)
        self.selection = Selection()
        self.panel = ParameterPanel(
            Painter(), self.player, self.selection, self.take, lambda: self.now
        )
        self.panel.wanted = True
        self.frame = World(Scenario(robots=[Robot()])).frame
        self.draw()

    def take(self, name, value, restart):
        self.now += self.cost
        self.set_to.append((name, value, restart))
        if self.reason and not restart:
            return self.reason
        self.source.set({name: value})
        return self.reason

    def draw(self, height=400):
        surface = pygame.Surface((400, 500), 0, 32)
        self.panel.draw(surface, pygame.Rect(20, 20, 320, height), self.frame)
        return surface

    def send(self, kind, pixel):
        button = {} if kind == pygame.MOUSEMOTION else {"button": 1}
        return self.panel.handle(pygame.Event(kind, pos=pixel, **button))

    def at(self, name, value):
        slider = self.panel._sliders[name]
        return round(slider.x_of(value)), slider._line.centery

    def press(self, *names):
        for name in names:
            taken, *_ = [self.panel.press(event) for event in pressed(name)]
            assert taken

    def value(self, name):
        return self.panel.parameters()[name].value


def test_a_drag_sets_a_value_now_and_then_while_time_passes_and_at_its_end(file):
    desk = Desk(file)
    assert desk.send(pygame.MOUSEBUTTONDOWN, desk.at("mu", 0.6))
    for k in range(100):
        desk.send(pygame.MOUSEMOTION, desk.at("mu", 0.6 + 0.004 * k))
        desk.panel.tick()
        desk.now += 0.01
    desk.send(pygame.MOUSEBUTTONUP, desk.at("mu", 1.0))
    values = [value for _, value, _ in desk.set_to]
    assert values == sorted(values)
    assert 9 <= len(values) <= 12, "ten times a second"
    assert desk.value("mu") == pytest.approx(1.0, abs=0.01)


def test_what_needs_a_new_start_waits_until_it_is_let_go_of_and_says_so(file):
    desk = Desk(file)
    desk.reason = "3 robots in place of 2"
    desk.send(pygame.MOUSEBUTTONDOWN, desk.at("robots", 2))
    for value in (3, 4, 3):
        desk.now += 1.0
        desk.send(pygame.MOUSEMOTION, desk.at("robots", value))
        desk.panel.tick()
    assert desk.set_to == [("robots", 3, False)]
    assert desk.panel._words()[0] == "let go to start again: 3 robots in place of 2"
    desk.send(pygame.MOUSEBUTTONUP, desk.at("robots", 3))
    assert desk.set_to[1:] == [("robots", 3, True)]
    assert desk.panel.said[0] == "robots = 3: started again: 3 robots in place of 2"


def test_a_press_beside_a_handle_moves_it_there_and_a_click_on_a_name_does_not(file):
    desk = Desk(file)
    desk.send(pygame.MOUSEBUTTONDOWN, desk.at("mu", 0.9))
    desk.send(pygame.MOUSEBUTTONUP, desk.at("mu", 0.9))
    assert desk.value("mu") == pytest.approx(0.9, abs=0.01)
    desk.draw()
    place = desk.panel.places["laws.go.speed"]
    assert not desk.send(pygame.MOUSEBUTTONDOWN, (place.left + 8, place.top + 6))
    assert desk.panel.focus == "laws.go.speed"
    assert desk.value("laws.go.speed") == 0.1
    assert "0 to 0.4 m/s; 0.1 in the file" in desk.panel._words()[0]


def test_keys_move_the_slider_that_has_the_focus_and_type_numbers(file):
    desk = Desk(file)
    assert not any(map(desk.panel.press, pressed("right"))), "none has the focus"
    desk.panel.focus = "mu"
    desk.press("right")
    assert desk.value("mu") == 0.61
    desk.press("left")
    assert desk.value("mu") == 0.6
    desk.press("0", ".", "9", "8")
    assert desk.panel.typed.text == "0.98"
    desk.press("backspace", "return")
    assert desk.value("mu") == 0.9
    desk.press("down", "3", "return")
    assert desk.value("robots") == 3
    desk.press("up")
    assert desk.panel.focus == "mu"
    for words, said in (("9", "scenario(mu) = 9.0: expected a number >= 0.1 and <= 1.1"),
                        ("--", "--: expected a number")):  # fmt: skip
        desk.press(*words, "return")
        assert said in desk.panel.said[0]
        assert desk.panel.said[1] == "error"
    assert desk.value("mu") == 0.9
    desk.press("7", "escape")
    assert (desk.panel.typed.text, desk.panel.focus) == ("", "mu")
    desk.press("escape")
    assert desk.panel.focus is None
    assert not any(map(desk.panel.press, pressed("escape")))
    desk.panel.focus = "mu"
    assert not any(map(desk.panel.press, pressed("space"))), "other keys stay the window's"
    desk.panel.close()
    assert not any(map(desk.panel.press, pressed("right")))


def test_where_there_is_little_room_the_wheel_and_the_focus_scroll(file):
    desk = Desk(file)
    desk.selection.body = 0
    least, wanted = desk.panel.heights(desk.frame, 300)
    assert LEAST_ROWS * ROW < least < wanted
    desk.draw(round(least))
    first = next(iter(desk.panel.places))
    assert first == "robots.red0.mass", "those of the body that was just selected"
    assert "robots.red0.drive.max_torque" not in desk.panel.places
    for _ in range(40):
        desk.panel.handle(pygame.Event(pygame.MOUSEWHEEL, y=-1))
    desk.draw(round(least))
    assert "robots.red0.drive.max_torque" in desk.panel.places
    assert "mu" not in desk.panel.places
    desk.panel.focus = "robots.red0.drive.max_torque"
    desk.press("down")
    desk.draw(round(least))
    assert desk.panel.focus == "mu"
    assert desk.panel.places["mu"].height == ROW


def test_a_file_without_parameters_and_a_failing_value_are_said(file):
    desk = Desk(file)
    desk.source.restart(open_experiment("go_to_point"))
    assert desk.panel.parameters() == {}
    assert desk.panel._look()[0][0].startswith("No parameters")
    assert desk.panel._words()[0].startswith("select a robot or prop")
    desk.source.restart(open_experiment(file))
    desk.panel.focus = "mu"

    def refuse(name, value, restart):
        raise InputError("no such value")

    desk.panel._set_to = refuse
    desk.press("right")
    assert desk.panel.said == ("no such value", "error")


# -- a window ---------------------------------------------------------------------------------


def value(window, name):
    return window.state["sliders"]["values"][name]


def pixel(window, name, share):
    left, top, width, height = window.state["sliders"]["places"][name]
    return round(left + share * width), top + height // 2


def test_a_slider_is_dragged_while_the_run_goes_on(open_window, file):
    window = open_window(1, experiment=str(file))
    window.do("mousemove", *window.state["buttons"]["parameters"], "click", 1)
    window.until(lambda s: "laws.go.speed" in s["sliders"].get("places", {}))
    window.until(lambda s: s["row"] > 3)
    way = [pixel(window, "laws.go.speed", share) for share in (0.25, 0.5, 0.75, 1.0)]
    window.slide(*way)
    window.until(lambda s: value(window, "laws.go.speed") == 0.4)
    window.until(lambda s: s["sliders"]["said"].startswith("go.speed = 0.400 m/s: in effect"))
    row = window.state["row"]
    assert row > 3
    assert window.state["marks"]["hand"]
    before = window.state["robots"][0][0], window.state["time"]
    seen = window.until(lambda s: s["time"] > before[1] + 1.0)
    speed = (seen["robots"][0][0] - before[0]) / (seen["time"] - before[1])
    assert speed == pytest.approx(0.4, abs=0.05)
    window.press("ctrl+z")
    window.until(lambda s: s["sliders"]["values"]["laws.go.speed"] == 0.1)


def test_more_robots_start_anew_and_a_heavier_crate_does_not(open_window, file):
    window = open_window(1, experiment=str(file))
    window.press("space", "F2")
    window.until(lambda s: s["sliders"] and not s["playing"])
    window.press("Right", "Right")
    window.until(lambda s: s["row"] >= 2)
    window.slide(pixel(window, "robots", 0.34), pixel(window, "robots", 1.0))
    seen = window.until(lambda s: len(s["robots"]) == 4)
    assert seen["row"] == 0
    assert seen["sliders"]["said"].startswith("robots = 4: started again: 4 robots in place of 2")
    window.press("Escape", "Right", "Right")
    window.until(lambda s: s["row"] == 2)
    window.click(2, 1)
    window.until(lambda s: s["selected"] is not None)
    window.until(lambda s: "props.crate.mass" in s["sliders"].get("places", {}))
    window.do("mousemove", *pixel(window, "props.crate.mass", 0.5), "click", 1)
    window.press("3", "period", "5", "Return")
    window.until(lambda s: s["sliders"]["values"]["props.crate.mass"] == 3.5)
    assert window.state["row"] == 2
    window.until(lambda s: "props.crate.mass" in s["sliders"]["resets"])
    window.do("mousemove", *window.state["sliders"]["resets"]["props.crate.mass"], "click", 1)
    window.until(lambda s: s["sliders"]["values"]["props.crate.mass"] == 2.0)
