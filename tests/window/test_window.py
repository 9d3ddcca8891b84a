"""The window, driven by key presses and mouse moves: what is seen.

What keys and mouse do with time, with the run and with files is in test_window_*.py.
"""

import ast
import sys
from pathlib import Path

import numpy as np
import pygame
import pytest

from mars2d.core.errors import InputError
from mars2d.window.run import keys
from mars2d.window.run.window import Window
from mars2d.window.screen.display import display_available
from tests.processes import HIDDEN
from tests.window.circling import Circling
from tests.window.person import differing, has

VIOLET = (0x7B, 0x32, 0x94)


def banner(seen, color):
    """Return whether there is a banner of a colour across the foot."""
    return (seen[440:] == color).all(axis=2).sum() > 10_000


# -- layers ---------------------------------------------------------------------------------------


def test_layers_are_switched_by_keys(open_window):
    window = open_window(20, rows=60, pressed=True, talking=True, marked=True)
    window.until(lambda s: s["over"])
    layers = {
        "g": "grid", "t": "trails", "s": "sensors", "i": "names", "u": "velocities", "y": "theory",
        "x": "forces", "m": "messages", "o": "addons",
    }  # fmt: skip
    for key, layer in layers.items():
        was, before = window.state["layers"][layer], window.still()
        window.press(key)
        window.until(lambda s, layer=layer, was=was: s["layers"][layer] is not was)
        changed = lambda seen, before=before: differing(before, seen) > 50  # noqa: E731
        assert window.shows(changed), layer
        window.press(key)
        window.until(lambda s, layer=layer, was=was: s["layers"][layer] is was)
        # Paths drawn at once differ by a shade here and there from paths that have grown.
        same = lambda seen, before=before: differing(before, seen, by=80) < 10  # noqa: E731
        assert window.shows(same), layer


def test_layers_begin_as_the_animation_says(open_window):
    look = {"grid": False, "wake": False, "theory": True}
    window = open_window(0, scenario={"animation": look})
    layers = window.state["layers"]
    assert (layers["grid"], layers["trails"], layers["theory"]) == (False, False, True)
    assert layers["sensors"]
    before = window.still()
    assert has(before, VIOLET)
    window.press("g")
    window.until(lambda s: s["layers"]["grid"])
    assert window.shows(lambda seen: differing(before, seen) > 1000)


def test_d_and_z_change_the_light_and_the_size_of_text_and_f11_fills_the_screen(
    open_window, monkeypatch
):
    turned = []
    monkeypatch.setattr(pygame.display, "toggle_fullscreen", lambda: turned.append(True))
    window = open_window(0)
    window.press("F11")
    assert turned
    before = window.still()
    bright = before.mean()
    window.press("d")
    window.until(lambda s: s["dark"])
    assert window.shows(lambda seen: seen.mean() < 0.4 * bright)
    window.press("d")
    window.until(lambda s: not s["dark"])
    assert window.shows(lambda seen: differing(before, seen) == 0)
    for size in (1.3, 1.7, 2.2, 1.0):
        window.press("z")
        window.until(lambda s, size=size: s["text"] == size)
    assert window.says("text 1 times")


def test_f1_turns_the_pages_of_help_and_escape_closes_it(open_window):
    window = open_window(0, text=1.7)
    before = window.still()
    pages = []
    window.press("F1")
    window.until(lambda s: s["help"] == 0)
    assert window.shows(lambda seen: differing(before, seen) > 20_000)
    while window.settle()["help"] is not None:
        pages.append(window.look())
        window.press("F1")
    assert len(pages) > 1  # large text takes more than one
    assert differing(*pages[:2]) > 1000
    assert window.shows(lambda seen: differing(before, seen) == 0)
    window.press("F1")
    window.until(lambda s: s["help"] == 0)
    window.press("Escape")
    window.until(lambda s: s["help"] is None)
    assert "left" not in window.settle()


def test_the_mouse_does_nothing_to_what_the_help_lies_on(open_window):
    window = open_window(0)
    start = window.state
    window.press("F1")
    window.until(lambda s: s["help"] == 0)
    window.click(4, 0)
    window.slide((300, 300), (340, 280))
    assert window.settle()["selected"] is None
    assert window.state["origin"] == start["origin"]
    window.press("Escape")
    window.until(lambda s: s["help"] is None)


def test_a_click_selects_a_robot_and_shows_the_force_on_it(open_window):
    window = open_window(0, pressed=True)
    window.press(*["Right"] * 5)
    window.until(lambda s: s["row"] == 5)
    window.do("mousemove", 60, 300)
    before = window.still()
    (first, second), away = window.state["robots"], (-4, -4)
    window.click(*first[:2])
    window.until(lambda s: s["selected"] == 0)
    assert window.shows(lambda seen: differing(before, seen) > 5_000)
    window.click(*second[:2])
    window.until(lambda s: s["selected"] == 1)
    window.click(*away)
    window.until(lambda s: s["selected"] is None)
    window.do("mousemove", 60, 300)
    assert window.shows(lambda seen: differing(before, seen) == 0)


def test_a_drag_of_the_picture_pans_and_selects_nothing(open_window):
    window = open_window(0)
    before = window.state
    window.slide((300, 300), (340, 280))
    panned = window.until(lambda s: s["origin"] != before["origin"])
    panned = window.settle()
    assert panned["origin"][0] - before["origin"][0] == pytest.approx(40, abs=0.2)
    assert panned["origin"][1] - before["origin"][1] == pytest.approx(-20, abs=0.2)
    assert panned["selected"] is None


def test_tab_selects_one_after_the_other_and_escape_none(open_window):
    window = open_window(0)
    for wanted in (0, 1, None, 0):
        window.press("Tab")
        window.until(lambda s, wanted=wanted: s["selected"] == wanted)
    window.press("F1", "Escape")
    window.until(lambda s: s["help"] is None)
    assert window.settle()["selected"] == 0
    window.press("Escape")
    window.until(lambda s: s["selected"] is None)
    assert "left" not in window.settle()
    window.press("Escape")
    window.says("Ctrl Q closes the window")


def test_the_wheel_zooms_about_the_pointer_and_f_fits(open_window):
    window = open_window(0)
    start = window.state
    before = window.still()
    window.do("mousemove", 500, 250, "click", 4, "click", 4)
    zoomed = window.until(lambda s: s["scale"] > 1.3 * start["scale"])
    for axis, pointer in ((0, 500), (1, 250)):
        world = [(pointer - s["origin"][axis]) / s["scale"] for s in (start, zoomed)]
        assert world[0] == pytest.approx(world[1], abs=0.02)
    assert window.shows(lambda seen: differing(before, seen) > 1000)
    window.do("click", 5)
    window.until(lambda s: s["scale"] < zoomed["scale"])
    window.press("f")
    window.until(lambda s: (s["scale"], s["origin"]) == (start["scale"], start["origin"]))
    assert window.shows(lambda seen: differing(before, seen) == 0)


def test_l_follows_what_is_selected_until_the_picture_is_dragged(open_window):
    window = open_window(2, rows=400)
    window.press("Tab", "l")
    window.until(lambda s: s["following"])

    def off_center(state):
        (left, top), scale = state["origin"], state["scale"]
        x, y, _ = state["robots"][0]
        return np.hypot(left + scale * x - 420, top - scale * y - 280)

    window.until(lambda s: s["time"] > 2 and off_center(s) < 130)  # beside the inspector
    later = window.until(lambda s: s["time"] > 4)
    assert off_center(later) < 130
    window.press("l")
    window.until(lambda s: not s["following"])
    window.press("l")
    window.until(lambda s: s["following"])
    window.slide((300, 450), (340, 440))
    window.until(lambda s: not s["following"])
    window.press("l", "f")
    window.until(lambda s: not s["following"] and s["origin"][0] < 300)  # beside the inspector


# -- the ends -------------------------------------------------------------------------------------


def test_the_end_is_told_in_a_banner_until_one_looks_back(open_window):
    window = open_window("max", rows=30, message="robot0 has caught robot1")
    window.until(lambda s: s["over"] and s["banner"] == "robot0 has caught robot1")
    assert window.shows(lambda seen: banner(seen, (0x24, 0x3B, 0x53)))
    window.press("Left")
    window.until(lambda s: s["row"] == 29 and s["banner"] is None)
    window.press("r")
    window.until(lambda s: s["restarts"] == 1)
    window.press("space")  # going back has paused it
    window.until(lambda s: s["over"])


def test_the_close_button_closes_it(open_window):
    window = open_window(1)
    window.ask_to_close()
    window.until(lambda s: s.get("left"))


# -- without a display ----------------------------------------------------------------------------


@pytest.fixture
def no_display(monkeypatch):
    for name in HIDDEN:
        monkeypatch.delenv(name, raising=False)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is always one elsewhere")
def test_without_a_display_the_error_says_what_to_do_instead(no_display):
    assert not display_available()
    with pytest.raises(InputError, match=r"--headless.*--figure.*--video"):
        Window(Circling(), 1).run()


# -- all of them ----------------------------------------------------------------------------------

ON_A_KEYBOARD = {",": "comma", ".": "period",
    "PgDn": "Next", "PgUp": "Prior", "→": "Right", "←": "Left", "+": "plus",
    "\N{MINUS SIGN}": "minus", "Esc": "Escape", "Space": "space",
}  # fmt: skip


def on_a_keyboard(label):
    """Return what xdotool calls keys that the window calls otherwise."""
    *held, last = label.split()
    last = ON_A_KEYBOARD.get(last, last.lower() if len(last) == 1 else last)
    return "+".join([*(each.lower() for each in held), last])


GESTURES = {
    "zoom": "test_the_wheel_zooms_about_the_pointer_and_f_fits",
    "pan": "test_a_drag_of_the_picture_pans_and_selects_nothing",
    "pick": "test_a_click_selects_a_robot_and_shows_the_force_on_it",
    "carry": "test_escape_puts_back_what_is_carried_and_a_right_drag_turns",
    "aim": "test_shift_and_drag_push_with_the_newtons_at_the_arrow_and_undo_takes_them_back",
    "menu": "test_a_right_click_opens_what_can_be_done_with_a_body",
    "turn": "test_escape_puts_back_what_is_carried_and_a_right_drag_turns",
}


def test_every_key_and_gesture_of_the_help_has_a_test():
    pressed, tests = set(), set()
    folder = Path(__file__).parent
    for path in (*folder.glob("test_window*.py"), folder / "test_parameter_panel.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                tests.add(node.name)
                texts = [each for each in ast.walk(node) if isinstance(each, ast.Constant)]
                pressed |= {each.value for each in texts if isinstance(each.value, str)}
    untested = [
        each.name
        for each in keys.ACTIONS
        if not any(on_a_keyboard(label) in pressed for label in (*each.labels, *each.also))
    ]
    assert untested == []
    assert {each.name for each in keys.MOUSE} == set(GESTURES)
    assert set(GESTURES.values()) <= tests
