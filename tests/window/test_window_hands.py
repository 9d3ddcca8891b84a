"""Hands in the window: who drives a robot, what is put elsewhere, what is drawn on a paused run."""

from math import pi

import numpy as np
import pytest


def test_keys_drive_against_the_law_and_escape_lets_go(open_window, room):
    window = open_window(1, experiment=str(room))
    window.press("h")  # the first robot, as none is selected
    window.until(lambda s: (s["driving"], s["selected"]) == (0, 0) and "driving red" in s["chip"])
    there = window.settle()["robots"][0]
    row = window.state["row"]
    window.until(lambda s: s["row"] > row + 3)
    assert window.state["robots"][0] == there  # it waits for keys
    for key, moves in {
        "Down": lambda x, y, a: x < there[0] - 0.1,  # its law goes ahead
        "d": lambda x, y, a: a < -0.3,
        "Left": lambda x, y, a: a > 0.0,
        "w": lambda x, y, a: x > there[0] + 0.05,
    }.items():
        window.do("keydown", key)
        window.until(lambda s, moves=moves: moves(*s["robots"][0]))
        window.do("keyup", key)
    assert window.settle()["layers"]["grid"]
    assert not window.state["dark"]  # D drives
    window.press("g", "space")  # other keys do what they always do
    window.until(lambda s: not s["layers"]["grid"] and not s["playing"])
    window.press("space", "Escape")
    window.until(lambda s: s["driving"] is None and s["playing"])
    assert window.state["selected"] == 0
    x = window.state["robots"][0][0]
    window.until(lambda s: s["robots"][0][0] > x + 0.1)
    window.press("Tab", "Tab", "h")
    window.says("crate has no drive")
    assert window.settle()["driving"] is None


def test_played_from_the_past_the_first_key_that_drives_makes_a_branch(open_window, room):
    window = open_window(10, experiment=str(room))
    window.until(lambda s: s["newest"] > 40)
    window.press("space", "Home", "h")
    window.until(lambda s: s["driving"] == 0 and s["row"] == 0)
    assert window.settle()["branches"] == 0
    window.do("keydown", "s", "sleep", "0.2", "keyup", "s")
    assert window.settle()["branches"] == 0  # who looks back changes nothing
    window.press("space")
    window.do("keydown", "s")
    window.until(lambda s: s["branches"] == 1)
    window.until(lambda s: s["robots"][0][0] < -2.05)
    window.do("keyup", "s")


def test_escape_puts_back_what_is_carried_and_a_right_drag_turns(open_window, room):
    window = open_window(0, experiment=str(room))
    window.drag((1, -1), (1.2, 0), (1.5, 0.5), drop=False)
    window.until(lambda s: s["busy"] and s["props"][0][0] == pytest.approx(1.5, abs=0.05))
    window.press("Escape")
    window.until(lambda s: not s["busy"] and s["props"][0] == [1, -1, 0])
    window.do("mouseup", 1)
    window.drag((1, -1), (1, 0), (1, 0.5), button=3)
    window.until(lambda s: s["props"][0] == pytest.approx([1, -1, pi / 2], abs=0.05))
    window.drag((1, -1), (-1, 0.5), (-2, 0.5))  # onto red
    window.until(lambda s: any("red" in note for note in s["notes"]))
    assert window.settle()["props"][0][:2] == pytest.approx([1, -1], abs=1e-3)
    assert "left" not in window.settle()


def test_a_drag_that_an_editor_interrupts_is_not_gone_on_with(open_window, room):
    window = open_window(0, experiment=str(room))
    window.drag((1, -1), (1.2, 0), (1.5, 0.5), drop=False)
    window.until(lambda s: s["busy"])
    window.press("e")
    window.until(lambda s: s["editor"])
    window.do("mouseup", 1)
    window.press("Escape")
    window.until(lambda s: s["editor"] is None)
    window.point(0, 0)
    window.until(lambda s: not s["busy"] and s["props"][0] == [1, -1, 0])


# -- the editor on a paused run -------------------------------------------------------------------


def draw_wall(window, *corners):
    """Draw a wall in the editor; its camera may differ from the window's."""
    scale, (left, top) = (window.state["editor"][name] for name in ("scale", "origin"))
    window.press("w")
    window.until(lambda s: s["editor"]["tool"] == "wall")
    for k, (x, y) in enumerate(corners, 1):
        window.do("mousemove", round(left + scale * x), round(top - scale * y), "click", 1)
        window.until(lambda s, k=k: s["editor"]["corners"] == k)
    window.press("Return")
    window.until(lambda s: len(s["editor"]["walls"]) == 1)


def test_a_wall_drawn_in_a_paused_run_stops_a_robot_from_now_on(open_window, room):
    window = open_window(5, experiment=str(room))
    window.until(lambda s: s["newest"] > 10)
    window.press("e")
    state = window.until(lambda s: s["editor"] and not s["playing"])
    assert state["time"] == pytest.approx(0.1 * state["row"])  # not in between two steps
    draw_wall(window, (-0.5, 0), (-0.5, 1))
    window.press("Return")
    window.until(lambda s: s["editor"] is None)
    assert window.says("from now")["row"] == state["row"]
    window.press("space")
    window.until(lambda s: s["time"] > 12)
    # Without the wall it would be 2.4 m from where it began.
    assert np.allclose(window.state["robots"][0][0], -0.5 - 0.275, atol=0.3)
    assert window.state["marks"]["collision"]


def test_with_shift_it_starts_anew_with_what_was_drawn(open_window, room):
    window = open_window(5, experiment=str(room))
    window.until(lambda s: s["newest"] > 10)
    window.press("e")
    window.until(lambda s: s["editor"])
    draw_wall(window, (-1, 0), (-1, 1))
    window.press("shift+Return")
    window.until(lambda s: s["editor"] is None and s["row"] == 0)
    window.says("started again")
    window.press("e", "Escape")  # nothing drawn: nothing changes
    window.until(lambda s: s["editor"] is None)
    assert window.settle()["row"] == 0
    assert "left" not in window.settle()


def test_drawn_in_the_past_it_makes_a_branch(open_window, room):
    window = open_window(20, experiment=str(room))
    window.until(lambda s: s["newest"] > 60)
    window.press("Home")
    window.steps(10)
    window.press("e")
    window.until(lambda s: s["editor"] and s["row"] == 10)
    draw_wall(window, (-1, 0), (-1, 1))
    window.press("Return")
    window.until(lambda s: s["editor"] is None and s["branches"] == 1 and s["newest"] == 10)


def test_how_the_editor_looks_stays_so_in_the_window(open_window, room):
    window = open_window(0, experiment=str(room))
    window.press("e")
    window.until(lambda s: s["editor"] is not None)
    window.press("z", "d", "Escape")
    window.until(lambda s: s["editor"] is None and s["text"] == 1.3 and s["dark"])
