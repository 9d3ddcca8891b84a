"""Scopes in a window: chosen by mouse, scrubbed, saved."""

import pygame
import pytest

from tests.window.person import PUSHING
from tests.window.test_window_buttons import choose, push


def test_scopes_are_chosen_by_mouse_for_several_bodies(open_window, pushing):
    window = open_window(0, experiment=str(pushing))
    push(window, "scopes")
    choose(window, "Speed")
    window.until(lambda s: s["scopes"] == {"speed": [0, 1]} and "speed" in s["areas"])
    choose(window, "Energy, and what has made it")
    window.until(lambda s: "energy" in s["areas"])
    push(window, "scopes")
    window.until(lambda s: not s["menu"])
    window.press("Tab", "Tab", "Tab")
    window.until(lambda s: s["selected"] == 2)
    window.press("q")
    choose(window, "Speed")
    window.until(lambda s: s["scopes"]["speed"] == [0, 1, 2])
    choose(window, "Distance to red")
    window.until(lambda s: s["scopes"].get("distance.red") == [2])
    window.press("Escape")
    window.until(lambda s: not s["menu"])
    window.press("Escape")
    window.until(lambda s: s["selected"] is None)
    window.do("mousemove", *window.state["closes"]["scopes"], "click", 1)
    window.until(lambda s: not s["panels"])


def test_a_click_in_a_plot_goes_to_that_time_and_a_drag_scrubs(open_window, pushing):
    window = open_window(0, experiment=str(pushing))
    window.steps(199)
    window.until(lambda s: s["row"] == 199)
    push(window, "scopes")
    choose(window, "Contact force")
    left, top, width, height = window.until(lambda s: s["areas"])["areas"]["contact force"]
    push(window, "scopes")
    middle = top + height // 2
    window.do("mousemove", left + width // 2, middle, "click", 1)
    window.until(lambda s: abs(s["row"] - 100) <= 2 and s["past"])
    window.do("mousemove", left + width // 4, middle, "mousedown", 1)
    window.until(lambda s: abs(s["row"] - 50) <= 2)
    window.do("mousemove", left + 3 * width // 4, middle - 200)
    window.until(lambda s: abs(s["row"] - 150) <= 2)
    window.do("mouseup", 1)


def test_what_is_plotted_is_saved_as_a_figure(open_window, pushing, tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    window = open_window(0, experiment=str(pushing), folder=folder)
    window.steps(30)
    window.until(lambda s: s["row"] == 30)
    window.click(-2 + 0.2 * 3, 0.5, button=3)
    choose(window, "Plot over time")
    choose(window, "x")
    window.until(lambda s: "x" in s["areas"])
    choose(window, "Save the plots as a figure")
    window.says("figure: ")
    size = pygame.image.load(folder / "pushing_1.png").get_size()
    assert min(size) > 200


def test_the_scopes_of_a_file_are_open_and_keys_show_less_time_and_more(open_window, pushing):
    pushing.write_text(PUSHING + '\n\nscopes = ["speed", gap]\n')
    window = open_window(1, experiment=str(pushing))
    window.until(lambda s: {"speed", "gap"} <= {*s["areas"]})
    window.press("comma", "comma")
    assert window.shown.dock.scopes.span == pytest.approx(10 / 1.25**2)
    window.press("period", "period", "period")
    assert window.shown.dock.scopes.span is None
    window.press("q")
    choose(window, "gap")
    window.until(lambda s: "gap" not in s["scopes"])
