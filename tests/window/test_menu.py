"""Menus: the mouse and the keyboard choose, and nothing behind an open menu gets a key."""

import pygame
import pytest

from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.menu import Entry, Menu
from tests.window.strokes import press

pytestmark = pytest.mark.usefixtures("keyboard")

CTRL = pygame.KMOD_LCTRL
BOUNDS = pygame.Rect(0, 0, 640, 400)


class Opened:
    """An open menu of some titles, and what was chosen from it."""

    def __init__(self, *titles, keys=None, boxed=False, stays=False):
        self.done, self.menu, self.painter = [], Menu(), Painter()
        self.entries = [Entry("A heading")] + [
            Entry(each, lambda each=each: self.done.append(each), (keys or {}).get(each, ""),
                  each in self.done if boxed else None)
            for each in titles
        ]  # fmt: skip
        self.menu.open("it", lambda: self.entries, (20, 20), stays=stays)
        self.draw()

    def draw(self):
        surface = pygame.Surface(BOUNDS.size, 0, 32)
        self.menu.draw(surface, BOUNDS, self.painter)
        return surface

    def press(self, *names, mod=0):
        return press(self.menu, *names, mod=mod)


def test_arrows_go_round_and_enter_chooses():
    it = Opened("One", "Two", "Three")
    chosen = []
    for key in ("down", "down", "down", "up", "home", "end"):
        it.press(key)
        chosen.append(it.menu.chosen)
    assert chosen == ["Two", "Three", "One", "Three", "One", "Three"]
    it.press("return")
    assert it.done == ["Three"]
    assert not it.menu.is_open


def test_letters_choose_by_the_beginning_of_a_title():
    it = Opened("Sumo", "Sheep", "Wolf", "Swarm")
    chosen = []
    for letter in "shswx":
        assert it.press(letter)
        chosen.append(it.menu.chosen)
    assert chosen == ["Sumo", "Sheep", "Swarm", "Swarm", "Swarm"]


def test_the_key_beside_an_entry_chooses_it_and_boxes_keep_it_open():
    it = Opened("Grid", "Trails", keys={"Trails": "T", "Grid": "Ctrl Q"}, boxed=True)
    it.press("t", "t")
    it.press("q", mod=CTRL)
    assert it.done == ["Trails", "Trails", "Grid"]
    assert it.menu.is_open


def test_it_takes_all_keys_but_those_of_commands_which_close_it():
    it = Opened("One")
    for key in ("left", "right", "x", "5", "backspace", "page up"):
        assert it.press(key), key
        assert it.menu.is_open, key
    assert it.press("escape")
    assert not it.menu.is_open
    for key, mod in (("z", CTRL), ("f1", 0)):
        it = Opened("One")
        assert not it.press(key, mod=mod)
        assert not it.menu.is_open


def test_one_that_stays_leaves_nothing_but_commands_to_the_window():
    it = Opened("pursuer", "evader", keys={"evader": "2"}, stays=True)
    for key, mod in (("escape", 0), ("f1", 0), ("z", CTRL)):
        assert not it.press(key, mod=mod)
    for key in ("b", "space", "delete", "="):
        assert it.press(key), key
    assert it.menu.is_open
    assert it.press("e")
    assert it.menu.chosen == "evader"
    assert it.press("2")
    assert it.done == ["evader"]


def test_where_there_is_no_room_for_all_what_is_chosen_is_seen_and_no_rows_overlap():
    it = Opened(*(f"Entry {k}" for k in range(30)))
    it.painter.ui = 2.2
    for _ in range(40):
        it.draw()
        places = it.menu.places
        assert it.menu.chosen in places
        assert all(len(at.collidelistall([*places.values()])) == 1 for at in places.values())
        assert all(at.height >= 30 * 2.2 - 1 for at in places.values())
        assert BOUNDS.contains(it.menu.plate)
        it.press("down")
    it.menu.handle(pygame.Event(pygame.MOUSEWHEEL, x=0, y=1))
    it.draw()
    assert it.menu.chosen in it.menu.places
