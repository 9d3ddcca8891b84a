"""The field to type in: caret, selection, clipboard, dead keys and input methods."""

import pygame
import pytest

from mars2d.output.raster.painter import Painter
from mars2d.window.widgets import text_field
from mars2d.window.widgets.text_field import TextField
from tests.cases import each_case
from tests.window.strokes import press

pytestmark = pytest.mark.usefixtures("keyboard")

CTRL, SHIFT = pygame.KMOD_LCTRL, pygame.KMOD_LSHIFT


@pytest.fixture
def board(monkeypatch):
    """Return a clipboard that only this test has: a list of what was copied."""
    board = [""]
    monkeypatch.setattr(text_field, "copied", lambda text: board.append(text) is None)
    monkeypatch.setattr(text_field, "pasted", lambda: board[-1])
    return board


@each_case(
    "keys, text",
    [
        (["left", "left", "x"], "room sxix"), (["home", "x"], "xroom six"),
        (["home", "delete"], "oom six"), (["backspace"], "room si"),
        (["home", "end", "x"], "room sixx"), (["home", "backspace"], "room six"),
    ],
)  # fmt: skip
def test_keys_move_the_caret_and_text_comes_in_there(keys, text):
    field = TextField("room six")
    press(field, *keys)
    assert field.text == text


def test_shift_selects_and_what_is_typed_replaces_it():
    field = TextField("room six")
    press(field, "left", "left", "left", mod=SHIFT)
    assert field.selected == (5, 8)
    press(field, "7")
    assert (field.text, field.caret) == ("room 7", 6)
    press(field, "home", mod=SHIFT)
    press(field, "delete")
    assert field.text == ""
    assert not press(field, "left"), "an empty field leaves arrows to others"


def test_the_clipboard(board):
    field = TextField("0.25")
    press(field, "a", "c", mod=CTRL)
    assert board[-1] == "0.25"
    press(field, "right")
    press(field, "v", mod=CTRL)
    assert field.text == "0.250.25"
    press(field, "a", "x", mod=CTRL)
    assert (field.text, board[-1]) == ("", "0.250.25")
    board.append("two\nlines")
    press(field, "v", mod=CTRL)
    assert field.text == "two lines"


def test_dead_keys_and_input_methods_write_when_they_are_done():
    field = TextField("caf")
    field.handle(pygame.Event(pygame.TEXTEDITING, text="^", start=0, length=1))
    assert (field.text, field.composed) == ("caf", "^")
    assert press(field, "backspace"), "that is for the input method"
    assert field.text == "caf"
    field.handle(pygame.Event(pygame.TEXTINPUT, text="ê"))
    assert (field.text, field.composed) == ("cafê", "")


def test_only_what_is_accepted_is_taken_also_from_the_clipboard(board):
    field = TextField(accepts="0123456789.", most=4)
    assert press(field, "1")
    assert not press(field, "q"), "a letter is for others"
    assert not press(field, "return")
    board.append("x2.5678")
    press(field, "v", mod=CTRL)
    assert field.text == "12.5"


def test_the_text_of_the_key_that_opened_it_is_not_for_it():
    field = TextField(opened_by_key=True)
    field.handle(pygame.Event(pygame.TEXTINPUT, text="="))
    press(field, "3")
    assert field.text == "3"


def test_the_mouse_puts_the_caret_and_a_drag_selects():
    field, painter = TextField("room six"), Painter()
    surface = pygame.Surface((200, 40), 0, 32)
    field.draw(surface, pygame.Rect(10, 5, 180, 30), painter, 16)
    before = pygame.surfarray.array3d(surface)
    x = 10 + painter.fonts.width("room", 16)
    assert field.handle(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=(x + 1, 20), button=1))
    assert field.caret == 4
    field.handle(pygame.Event(pygame.MOUSEMOTION, pos=(0, 20), rel=(0, 0), buttons=(1, 0, 0)))
    assert field.selected == (0, 4)
    field.draw(surface, pygame.Rect(10, 5, 180, 30), painter, 16)
    assert (pygame.surfarray.array3d(surface) != before).sum() > 500, "the selection is seen"
    assert not field.handle(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=(1, 1), button=1))


def test_a_long_text_is_scrolled_to_its_caret():
    field, painter = TextField("a long name " * 9, most=500), Painter()
    surface = pygame.Surface((120, 40), 0, 32)
    for key in ("end", "home"):
        press(field, key)
        field.draw(surface, pygame.Rect(10, 5, 100, 30), painter, 16)
        assert 10 <= field._starts[field.caret] <= 110
