"""The buttons and menus of the window, pressed with the mouse."""

import re
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from mars2d import load, run
from mars2d.output.controls import CONTROLS
from mars2d.output.layers.table import LAYERS
from mars2d.record.marks import marks_of
from mars2d.window.run import keys, menus, toolbar


def push(window, button):
    """Press a button of the toolbar."""
    window.do("mousemove", *window.state["buttons"][button], "click", 1)


def choose(window, title):
    """Choose an entry of the open menu."""
    window.until(lambda s: title in s["menu"])
    window.do("mousemove", *window.state["menu"][title], "click", 1)


def offered(window, x, y):
    """Click with the right button on a point [m], and return the titles of the menu."""
    window.click(x, y, button=3)
    return set(window.until(lambda s: s["menu"])["menu"])


def test_each_button_does_what_the_key_of_the_same_label_does(open_window, monkeypatch):
    window, pressed = open_window(0, experiment="push_box"), []
    for bar in window.shown.toolbar.bars:
        for name in bar._actions:
            act = partial(pressed.append, name)
            monkeypatch.setitem(bar._actions, name, replace(bar._actions[name], act=act))
    groups = (*toolbar.TRANSPORT, toolbar.SEE, toolbar.CHANGE, toolbar.SAVE, toolbar.LOOK)
    names, by_action = [name for group in groups for name in group], keys.ACTIONS
    for name in names:
        push(window, name)
    assert pressed == names
    labels = {each.name: each.labels[0] for each in by_action}
    assert [CONTROLS[name].key for name in names] == [labels[name] for name in names]


def test_each_entry_is_chosen_by_one_of_these_tests():
    tests = "".join(path.read_text() for path in Path(__file__).parent.glob("test_window_*.py"))
    assert {*menus.TITLES.values()} <= set(re.findall(r'choose\(window, "([^"]+)"\)', tests))


def test_at_the_end_play_begins_again(open_window):
    window = open_window(20, rows=20)
    window.until(lambda s: s["over"])
    window.press("space")
    window.until(lambda s: s["past"] and s["playing"])
    window.until(lambda s: s["over"])


def test_layers_are_chosen_from_a_menu_that_stays_open(open_window):
    window = open_window(0)
    push(window, "layers")
    for layer in (each for each in LAYERS if each.switch):
        was = window.state["layers"][layer.name]
        choose(window, layer.title)
        window.until(lambda s, name=layer.name, was=was: s["layers"][name] is not was)
    push(window, "layers")
    window.until(lambda s: not s["menu"])
    window.press("a")
    window.until(lambda s: "Grid" in s["menu"])
    window.press("Escape")
    window.until(lambda s: not s["menu"])
    assert "left" not in window.settle()


def test_a_right_click_opens_what_can_be_done_with_a_body(open_window, room):
    window = open_window(0, experiment=str(room))
    assert "Drive by hand" not in offered(window, 1, -1)  # a crate
    choose(window, "Follow with the camera")
    window.until(lambda s: s["following"] and s["selected"] == 2)
    push(window, "fit")
    window.until(lambda s: not s["following"])
    window.press("Escape")
    window.until(lambda s: s["selected"] is None)
    offered(window, -2, 0.5)
    choose(window, "Drive by hand")
    window.until(lambda s: s["driving"] == 0)


def test_a_right_click_on_the_floor_shows_all_and_undoes(open_window, room):
    window = open_window(0, experiment=str(room))
    window.press("ctrl+z")
    window.says("nothing was done by hand")
    window.drag((1, -1), (1.2, 0), (1.5, 0.5))
    window.until(lambda s: s["props"][0][:2] == pytest.approx([1.5, 0.5], abs=0.05))
    window.press("Right", "Right")
    window.until(lambda s: s["row"] == 2)
    offered(window, 0, 1.5)
    choose(window, "Undo what was done by hand")
    window.until(lambda s: s["props"][0] == [1, -1, 0] and s["row"] == 0 and s["branches"] == 1)
    scale = window.state["scale"]
    window.press("ctrl+plus", "ctrl+plus", "ctrl+minus")
    assert 1.1 * scale < window.settle()["scale"] < 1.5 * scale
    offered(window, 0, 0.5)
    choose(window, "Show all")
    window.until(lambda s: s["scale"] == scale)
    offered(window, 2.5, 0)  # a wall
    choose(window, "Draw walls and more")
    window.until(lambda s: s["editor"] is not None)


# -- nothing is lost ------------------------------------------------------------------------------


def test_before_a_run_changed_by_hand_is_lost_the_window_asks(open_window, room, tmp_path):
    window = open_window(0, experiment=str(room), asks=True, folder=tmp_path)
    window.drag((1, -1), (1.2, 0), (1.5, 0.5))
    window.until(lambda s: s["props"][0][:2] == pytest.approx([1.5, 0.5], abs=0.05))
    window.press("Right")
    window.until(lambda s: s["row"] == 1)
    assert window.state["selected"] is None
    for stay in ("Escape", "stay"):
        window.press("ctrl+q")
        window.until(lambda s: "stay" in s["menu"])
        if stay == "stay":
            choose(window, "stay")
        else:
            window.press("Escape")
        window.until(lambda s: not s["menu"])
    window.press("ctrl+q")
    choose(window, "save it, and leave")
    window.until(lambda s: s.get("left"))
    (saved,) = tmp_path.glob("*.npz")
    record = load(saved)
    assert len(record.interventions) > 0
    assert record.prop_pose[-1, :2, 0] == pytest.approx([1.5, 0.5], abs=0.05)


@pytest.mark.parametrize("again", ["ctrl+q", "Down+Return"])
def test_asked_twice_to_close_the_window_does(open_window, room, tmp_path, again):
    window = open_window(0, experiment=str(room), asks=True, folder=tmp_path)
    window.press("Tab", "w", "Return", "Right", "ctrl+q")
    window.until(lambda s: s["menu"])
    window.press(*again.split("+") if again[0] == "D" else [again])
    window.until(lambda s: s.get("left"))
    assert not list(tmp_path.glob("*.npz"))


def test_a_run_that_can_be_run_again_is_not_asked_for(open_window, room):
    window = open_window(0, experiment=str(room), asks=True)
    window.press("Right")
    window.until(lambda s: s["row"] == 1)
    window.ask_to_close()
    window.until(lambda s: s.get("left"))


# -- contacts -------------------------------------------------------------------------------------


def meetings_of(path):
    return marks_of(run(str(path), show=False))["collision"]


@pytest.fixture
def bumping(tmp_path):
    """A ball that meets a wall again and again."""
    path = tmp_path / "bumping.py"
    path.write_text(BUMPING)
    return path


BUMPING = """
from mars2d import Robot, Scenario
from mars2d.bodies import Holonomic


def to_and_fro(robot):
    return (0.5 if robot.time % 4 < 2 else -0.5), 0.0


red = Robot(name="red", pose=(-1, 0, 0), drive=Holonomic(), controller=to_and_fro)
blue = Robot(name="blue", pose=(-0.5, 0, 0), mass=10.0)
scenario = Scenario(title="Bumping", robots=[red, blue], stop_time=20.0)
"""


def test_from_contact_to_contact(open_window, bumping):
    rows = meetings_of(bumping)
    assert len(rows) > 2
    window = open_window(0, experiment=str(bumping))
    window.press("n")
    window.until(lambda s: s["row"] == s["newest"] == rows[0] and s["layers"]["forces"])
    window.press("n")
    window.until(lambda s: s["row"] == s["newest"] == rows[1])
    window.press("shift+n")
    window.until(lambda s: s["row"] == rows[0] < s["newest"])
    window.press("shift+n")
    window.until(lambda s: s["row"] == 0)
    window.press("n", "n")
    window.until(lambda s: s["row"] == rows[1])


def test_at_a_contact_time_stops_if_it_is_to(open_window, bumping):
    rows = meetings_of(bumping)
    window = open_window(5, experiment=str(bumping))
    push(window, "contacts")
    window.says("time stops at contacts")
    for _ in range(2):
        window.until(lambda s: not s["playing"])
        assert window.state["row"] in rows
        window.press("space")
        window.until(lambda s: s["playing"])
    window.press("k")
    window.until(lambda s: s["over"])


def test_predictions_and_lesson_are_shown_by_a_button_and_a_key(open_window):
    window = open_window("max", experiment="billiards")
    for panel, key in (("lesson", "F4"), ("predictions", "F3")):
        push(window, panel)
        window.until(lambda s, panel=panel: panel in s["panels"])
        window.press(key)
        window.until(lambda s, panel=panel: panel not in s["panels"])
    window.press("F3")
    window.until(lambda s: s["over"] and s["predictions"] == [11, 11])
    assert [*dict(window.shown.dock.lesson.parts)] == ["", "Question", "Prediction", "Measured"]


def test_without_checks_there_is_no_button_for_predictions(open_window, room):
    window = open_window(1, experiment=str(room))
    assert "predictions" not in window.state["buttons"]
    window.press("F3")
    window.says("this file has no checks")


def test_a_right_click_selects_and_neither_moves_the_picture_nor_leaves_its_menu(open_window):
    window = open_window(1, experiment="push_box")
    window.press("space")
    view = window.state["scale"], window.state["origin"]
    window.click(*window.state["robots"][1][:2], button=3)
    window.until(lambda s: s["selected"] == 1 and "inspector" in s["panels"] and s["menu"])
    assert (window.state["scale"], window.state["origin"]) == view
    window.press("Escape", "Tab")
    window.until(lambda s: s["selected"] == 2)
    assert (window.state["scale"], window.state["origin"]) == view
