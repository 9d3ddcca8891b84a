"""Odd orders before the window: to look back while one pulls, to draw in the past, and the like.

The events are pygame's own, given by hand on a display that nobody sees.
"""

import os

import numpy as np
import pygame
import pytest

from mars2d.addons import Map
from mars2d.scenario.experiment import open_experiment
from mars2d.window.editor import Outcome
from mars2d.window.window import Window
from mars2d.world.timeline import Timeline
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


class Desk:
    """A window, and somebody who gives it events and lets pictures pass."""

    def __init__(self, path):
        self.path, self.clock = path, 0.0
        self.timeline = Timeline(open_experiment(path), seed=1)
        self.window = Window(self.timeline, 1.0, (800, 600))
        self.surface = pygame.display.set_mode((800, 600))
        self.pass_pictures(1)

    @property
    def where(self):
        timeline = self.timeline
        return timeline.row, timeline.newest, len(timeline.branches)

    @property
    def notes(self):
        return [note.text for note in self.window.notes._notes]

    def pass_pictures(self, count):
        for _ in range(count):
            self.window._pass_time(1 / 60)
            self.window.draw(self.surface)

    def play(self, rows):
        while self.timeline.row < rows:
            self.pass_pictures(1)

    def down(self, name):
        code = pygame.key.key_code(name)
        scancode = getattr(pygame, f"KSCAN_{name.upper()}", 0)
        character = name if len(name) == 1 else ""
        told = {"key": code, "unicode": character, "mod": 0, "scancode": scancode}
        self.window._handle(pygame.Event(pygame.KEYDOWN, **told))
        return told

    def press(self, *names):
        for name in names:
            self.window._handle(pygame.Event(pygame.KEYUP, **self.down(name)))
            self.pass_pictures(1)

    def pixel(self, robot):
        position = self.window.player.frame.pose[:2, robot]
        return tuple(self.window.camera.to_pixels([position])[0].round().astype(int).tolist())

    def move(self, pixel):
        told = {"pos": pixel, "rel": (0, 0), "buttons": (1, 0, 0)}
        self.window._handle(pygame.Event(pygame.MOUSEMOTION, **told))

    def grasp(self, pixel):
        self.move(pixel)
        self.window._handle(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=pixel, button=1))

    def drop(self, pixel=(400, 300)):
        self.window._handle(pygame.Event(pygame.MOUSEBUTTONUP, pos=pixel, button=1))
        self.pass_pictures(1)

    def drag(self, robot, by):
        x, y = self.pixel(robot)
        self.grasp((x, y))
        self.move((x + by[0], y + by[1]))
        self.pass_pictures(12)

    def save(self, text):
        """Save the experiment's file, and let pictures pass until it was read again."""
        stamp = self.path.stat().st_mtime_ns + 10**9
        self.path.write_text(text)
        os.utime(self.path, ns=(stamp, stamp))
        reload, self.clock = self.window._reload, self.clock + 2e6
        poll = type(reload).poll
        poll(reload, self.clock)  # it is seen to have changed,
        reloaded = poll(reload, self.clock + 1e6)  # and has rested
        reload.poll = lambda _: reloaded
        self.pass_pictures(1)
        reload.poll = lambda _: None


@pytest.fixture
def desk(monkeypatch, tmp_path):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.chdir(tmp_path)
    pygame.display.init()

    def sit(text=ROOM):
        path = tmp_path / "room.py"
        path.write_text(text)
        return Desk(path)

    yield sit
    pygame.display.quit()


# -- pulling --------------------------------------------------------------------------------------


@each_case("key", ["left", "home"])
def test_to_look_back_while_pulling_lets_go_and_makes_no_branch(desk, key):
    desk = desk()
    desk.play(12)
    desk.drag(0, by=(0, -80))
    assert len(desk.timeline.world.operator.pulls) == 1
    newest = desk.timeline.newest
    desk.press(key)
    assert desk.timeline.row < newest
    assert desk.where[1:] == (newest, 0)
    assert len(desk.timeline.world.operator.pulls) == 0
    assert desk.timeline.world.operator.log[-1].target is None
    desk.drop()
    assert desk.where[1:] == (newest, 0)


# -- driving --------------------------------------------------------------------------------------


def test_to_scrub_with_a_driving_key_held_changes_nothing(desk):
    desk = desk()
    desk.play(10)
    desk.press("h")
    desk.down("w")
    desk.play(20)
    bar = desk.window._controls.time_bar
    desk.grasp((round(bar.x_of(20)), bar._line.centery))
    for row in (15, 12, 9, 6):
        desk.move((round(bar.x_of(row)), bar._line.centery))
        desk.pass_pictures(2)
    desk.drop()
    newest = desk.timeline.newest
    assert desk.where == (6, newest, 0)
    assert newest >= 20
    desk.press("space")  # time passes: now it is driven there
    desk.pass_pictures(3)
    assert desk.where[2] == 1


# -- drawing --------------------------------------------------------------------------------------


def test_laws_go_on_where_a_wall_is_drawn_in_the_past(desk):
    desk = desk()
    desk.play(30)
    desk.window.player.go(20)
    desk.press("e")
    drawn = desk.window.director.scenario_now()
    wall = Map(walls=[[(2, 1), (2, 1.5)]])
    desk.window.editor.dialogs.outcome = Outcome(drawn.replace(addons=[*drawn.addons, wall]), "now")
    desk.window._close_editor(desk.window.editor)
    assert desk.where == (20, 20, 1)
    desk.press("space")
    desk.play(26)
    world = desk.timeline.world
    assert len(world.obstacles) == 1
    assert world.robots[0].memory.count == world.iteration
    (before,) = desk.timeline.branches
    assert np.array_equal(world.history.command[:26], before.history.command[:26])


def test_what_an_add_on_draws_of_theory_may_fail(desk):
    text = ROOM.replace(
        "    pass", "    def theory(self, scene, frame):\n        1 / (frame.time < 1)"
    )
    desk = desk(text)
    desk.press("y")
    desk.play(10)
    desk.pass_pictures(10)
    banner = desk.window._ending.banner()
    assert "room.py, line 16: add-on 'lines' raised ZeroDivisionError" in banner.text
    assert banner.excerpt.line == 16
    desk.press("p")
    assert (desk.path.parent / "room_1.png").exists()
    desk.press("left")
    assert desk.window._ending.banner() is None
    desk.press("end", "y", "r")
    assert desk.window.player.error is None


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


def test_a_sensor_that_fails_at_the_start_is_told_of_in_the_window_and_mended(desk):
    desk = desk(SENSED)
    banner = desk.window._ending.banner()
    assert "sensor 'bad' raised ZeroDivisionError" in banner.text
    assert banner.excerpt is not None
    desk.save(ROOM)
    assert desk.window._ending.banner() is None
    desk.play(5)
    desk.save(SENSED)
    assert desk.window._ending.banner().excerpt is not None


def test_a_mistake_that_is_mended_is_not_told_of_any_more(desk):
    desk = desk()
    desk.play(5)
    desk.save(ROOM.replace("while True:", "while True"))
    assert any("line 8" in note for note in desk.notes)
    desk.save(ROOM.replace("0.2, ", "0.3, "))
    assert desk.notes == ["room.py: in effect from now on; R runs it from the start"]


# -- films ----------------------------------------------------------------------------------------
