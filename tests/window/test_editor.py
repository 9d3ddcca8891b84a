"""The editor, driven by mouse moves and key presses."""

from math import degrees, pi

import numpy as np
import pytest

from mars2d.addons import Map
from mars2d.bodies.props import Box
from mars2d.cli.command_line import main
from mars2d.scenario import load_scenario
from mars2d.window.run.player_window import PlayerWindow
from mars2d.window.screen import display
from tests.cases import each_case
from tests.window.drawing import near, team
from tests.window.person import compare, differing

# -- tools ----------------------------------------------------------------------------------------


def test_a_click_puts_a_robot_and_a_drag_turns_it(open_editor):
    hands = open_editor()
    assert "no robot" in hands.state["fault"]
    hands.tool("r", "robot")
    hands.click(-2, 1)
    hands.until(lambda s: s["fault"] == "" and s["selection"] == [["robot", 0]])
    hands.drag((2, 1), (2, 2), (2, 3))
    hands.until(lambda s: len(s["robots"]) == 2 and near(s["robots"][1], (2, 1, pi / 2)))


def test_all_props_are_drawn(open_editor):
    hands = open_editor(team((4, 4)))
    hands.tool("b", "box")
    hands.click(-4, 4)
    hands.until(lambda s: s["props"] == [["Box", -4, 4, 0, 0.4, 0.4]])
    hands.drag((0, 3), (1, 4), (2, 4))
    hands.until(lambda s: near(s["props"][-1][1:], (1, 3.5, 0, 2, 1)))
    hands.tool("o", "ball")
    hands.drag((3, -2), (3.5, -2), (3.6, -2))
    hands.until(lambda s: s["props"][-1] == ["Ball", 3, -2, 0, 1.2])
    hands.tool("l", "bar")
    hands.drag((-3, 2), (-2, 2.5), (-3, 4))
    hands.until(lambda s: near(s["props"][-1][1:5], (-3, 3, pi / 2, 2)))
    hands.tool("t", "gate")
    hands.drag((-1, 0), (0, 0), (1, 0))
    hands.until(lambda s: near(s["props"][-1][1:5], (0, 0, 0, 2)))
    hands.tool("u", "puck")
    hands.drag((2, 2), (2.5, 2), (3, 2))
    hands.until(lambda s: s["props"][-1] == ["Puck", 2, 2, 0, 2])
    hands.tool("s", "solid")
    for corner in ((-3, -3), (0, -3), (-3, 0)):
        hands.click(*corner)
    hands.press("Return")
    hands.until(lambda s: near(s["props"][-1][1:], (-2, -2, 0)))
    hands.until(lambda s: s["fault"] == "" and s["selection"] == [["prop", 6]])
    for corner in ((0, -3), (1, -2), (1, -3), (0, -2)):
        hands.click(*corner)
    hands.press("Return")
    hands.until(lambda s: "crosses or touches itself" in s["notice"] and len(s["props"]) == 7)


def test_a_wall_is_a_chain_of_clicks(open_editor):
    hands = open_editor(team((4, 4)))
    hands.tool("w", "wall")
    for corner in ((-3, -3), (0, -3), (0, 1)):
        hands.click(*corner)
    hands.press("Escape")
    hands.until(lambda s: s["walls"] == [[[-3, -3], [0, -3], [0, 1]]] and s["corners"] == 0)
    hands.click(2, -2)
    hands.click(3, -2)
    hands.click(2, 2, button=3)
    hands.until(lambda s: len(s["walls"]) == 2 and s["tool"] == "wall")


def test_a_polygon_is_closed_at_its_first_corner(open_editor):
    hands = open_editor(team((4, 4)))
    hands.tool("p", "polygon")
    for corner in ((-3, -3), (0, -3), (1, 1)):
        hands.click(*corner)
    hands.press("BackSpace")
    hands.click(0, 0)
    hands.until(lambda s: s["corners"] == 3)
    hands.click(-2.95, -2.98)
    hands.until(lambda s: s["outlines"] == [[[-3, -3], [0, -3], [0, 0]]])
    assert hands.state["selection"] == [["outline", 0]]
    hands.click(3, 3)
    hands.press("Escape")
    hands.until(lambda s: s["corners"] == 0 and s["tool"] == "polygon")
    hands.press("Escape")
    hands.until(lambda s: s["tool"] == "select")


def test_rectangles_beacons_and_the_waypoints_of_the_robot_that_was_clicked(open_editor):
    hands = open_editor()
    hands.tool("y", "waypoint")
    hands.click(1, 1)
    hands.until(lambda s: "place one first (R)" in s["notice"])
    hands.tool("k", "rectangle")
    hands.drag((1, 1), (0, 0), (-2, -1))
    hands.click(3, 3)
    square = [[2.5, 2.5], [3.5, 2.5], [3.5, 3.5], [2.5, 3.5]]
    hands.until(lambda s: s["outlines"] == [[[-2, -1], [1, -1], [1, 1], [-2, 1]], square])
    hands.tool("n", "beacon")
    hands.click(1, 2)
    hands.tool("v", "select")
    hands.drag((1, 2), (0, 1), (-1, 2))
    hands.until(lambda s: s["beacons"] == [[-1, 2]])
    hands.tool("r", "robot")
    hands.click(-3, 0)
    hands.click(3, 0)
    hands.tool("y", "waypoint")
    hands.click(3, 2)
    hands.click(2, 3)
    hands.click(-3, 0)
    hands.until(lambda s: s["selection"] == [["robot", 0]])
    hands.click(-3, 2)
    hands.until(lambda s: s["routes"] == [[[-3, 2]], [[3, 2], [2, 3]]])
    hands.press("Escape")
    hands.drag((3, 2), (3, 1), (4, 1))  # a waypoint, and not its route
    hands.until(lambda s: s["routes"][1] == [[4, 1], [2, 3]] and s["corner"] == 0)
    hands.click(3, 2)  # the dot half-way
    hands.until(lambda s: s["routes"][1] == [[4, 1], [3, 2], [2, 3]] and s["corner"] == 1)
    hands.press("Delete", "Delete")  # the waypoint, then the route
    hands.until(lambda s: s["routes"] == [[[-3, 2]]])


def test_the_workspace_has_corners_to_drag_to_add_and_to_remove(open_editor):
    hands = open_editor(team((0, 0)))
    hands.press("m")
    hands.until(lambda s: s["selection"] == [["workspace", 0]])
    hands.drag((5, 5), (4, 4), (4, 3))
    hands.until(lambda s: s["workspace"] == [[-5, -5], [-5, 5], [4, 3], [5, -5]])
    hands.click(0, -5)  # the dot between two corners
    hands.until(lambda s: len(s["workspace"]) == 5 and s["corner"] == 4)
    hands.drag((0, -5), (2, -4), (2, -3))
    hands.until(lambda s: s["workspace"][4] == [2, -3])
    hands.press("Delete")
    hands.until(lambda s: s["workspace"] == [[-5, -5], [-5, 5], [4, 3], [5, -5]])
    hands.press("Delete")
    hands.until(lambda s: s["workspace"] is None)
    hands.press("m")
    hands.until(lambda s: len(s["workspace"]) == 4 and s["selection"])


def test_the_buttons_of_the_tool_bar_choose_tools_and_say_what_they_are(open_editor):
    hands = open_editor()
    before = hands.still()
    hands.do("mousemove", 26, 115)
    assert hands.shows(lambda seen: differing(before, seen, np.s_[95:140, 60:200]) > 300)
    hands.do("click", 1)
    hands.until(lambda s: s["tool"] == "robot")


# -- select, move, turn ---------------------------------------------------------------------------


def test_click_shift_click_and_a_rectangle_select(open_editor):
    hands = open_editor(team((-3, 0), (0, 0), (3, 0)))
    hands.click(0, 0)
    hands.do("keydown", "shift")
    hands.click(3, 0)
    hands.until(lambda s: s["selection"] == [["robot", 1], ["robot", 2]])
    hands.click(0, 0)
    hands.until(lambda s: s["selection"] == [["robot", 2]])
    hands.do("keyup", "shift")
    hands.click(0, 3)
    hands.until(lambda s: s["selection"] == [])
    hands.drag((-4, 1), (-1, 0), (1, -1))
    hands.until(lambda s: s["selection"] == [["robot", 0], ["robot", 1]])
    hands.click(0, 0)  # one of several
    hands.until(lambda s: s["selection"] == [["robot", 1]])
    hands.press("ctrl+a", "Delete")
    hands.until(lambda s: s["robots"] == [] and "no robot" in s["fault"])


def test_a_drag_moves_what_is_selected_on_the_grid_and_g_frees_it(open_editor):
    hands = open_editor(team((-3, 0), (0, 0)))
    hands.click(-3, 0)
    hands.do("keydown", "shift")
    hands.click(0, 0)
    hands.do("keyup", "shift")
    hands.drag((0.03, 0), (0.5, 0.6), (1.02, 1.03))
    hands.until(lambda s: near(s["robots"], [(-2, 1, 0), (1, 1, 0)], 1e-9))
    hands.press("g")
    hands.until(lambda s: s["notice"] == "points are free")
    hands.drag((1, 1), (1.2, 1.2), (1.31, 1.27))
    hands.until(lambda s: near(s["robots"][1][:2], (1.31, 1.27), 0.03))
    x = hands.state["robots"][1][0]
    assert abs(x / hands.state["step"] - round(x / hands.state["step"])) > 1e-6


def test_the_ring_turns_and_shift_makes_steps_of_15_degrees(open_editor):
    hands = open_editor(team((0, 0, pi / 2)))
    hands.click(0, 0)
    reach = max(30 * 0.9 / hands.state["scale"], 0.3 + 16 * 0.9 / hands.state["scale"])
    hands.drag((0, reach), (2, 2), (0.5, 2.5))
    heading = hands.settle()["robots"][0][2]
    assert degrees(heading) == pytest.approx(degrees(np.arctan2(2.5, 0.5)), abs=1.2)
    hands.press("ctrl+z")
    hands.do("keydown", "shift")
    hands.drag((0, reach), (2, 2), (1, 2.5))
    hands.do("keyup", "shift")
    assert degrees(hands.settle()["robots"][0][2]) == pytest.approx(75)  # of 68.2


def test_a_box_is_resized_by_its_corners(open_editor):
    box = Box(pose=(0, 0, pi / 2), length=2, width=0.8)
    hands = open_editor(team((4, 4), props=[box]))
    hands.click(0.3, 0.3)
    hands.until(lambda s: s["selection"] == [["prop", 0]])
    hands.drag((0.4, 1), (1, 1.5), (1.4, 2))
    hands.until(lambda s: near(s["props"][0][1:], (0.5, 0.5, pi / 2, 3, 1.8)))


def test_escape_puts_back_what_is_being_dragged(open_editor):
    hands = open_editor(team((0, 0)))
    hands.drag((0, 0), (1, 0), (2, 0), drop=False)
    hands.until(lambda s: s["robots"][0][0] == 2)
    hands.press("Delete", "Escape")  # the first does nothing while the button is down
    hands.do("mousemove", 300, 300, "mouseup", 1)
    assert hands.settle()["robots"] == [[0, 0, 0]]
    assert not hands.state["changed"]


def test_arrows_nudge_by_a_grid_step_and_with_shift_by_a_tenth(open_editor):
    hands = open_editor(team((0, 0)))
    hands.click(0, 0)
    step = hands.state["step"]
    hands.press("Right", "Right", "Up")
    hands.until(lambda s: near(s["robots"][0][:2], (2 * step, step), 1e-9))
    hands.press("shift+Left", "shift+Down")
    hands.until(lambda s: near(s["robots"][0][:2], (1.9 * step, 0.9 * step), 1e-9))
    hands.press("ctrl+z")  # nudges one after the other are one change
    hands.until(lambda s: s["robots"][0] == [0, 0, 0])


def test_keys_turn_a_robot_and_an_obstacle_about_its_middle(open_editor):
    corners = [(0, 0), (3, 0), (0, 3)]
    hands = open_editor(team((4, 4), addons=[Map([corners])]))
    hands.press("ctrl+Right")
    hands.until(lambda s: "select something" in s["notice"])
    hands.press("Tab", *["ctrl+Left"] * 6)
    hands.until(lambda s: near(s["outlines"][0], [(2, 0), (2, 3), (-1, 0)], 1e-6))
    hands.press("Tab", "ctrl+Left", "ctrl+shift+Right")
    hands.until(lambda s: near(degrees(s["robots"][0][2]), 14, 1e-6))
    hands.press("ctrl+z")  # turns one after the other are one change
    hands.until(lambda s: s["robots"][0][2] == 0)


def test_numbers_put_the_selection_exactly(open_editor):
    hands = open_editor(team((0, 0)))
    hands.press("equal")
    hands.until(lambda s: "select something" in s["notice"])
    hands.click(0, 0)
    hands.press("equal")
    hands.until(lambda s: s["typed"] == "0 0 0")
    hands.type("1.5 north")
    hands.press("Return")
    hands.until(lambda s: s["error"] and "expected x y" in s["error"])
    hands.press("BackSpace")
    hands.until(lambda s: s["typed"] == "1.5 nort" and not s["error"])
    hands.press("ctrl+a")
    hands.type("1.5 2 90")
    hands.press("Return")
    hands.until(lambda s: s["prompt"] is None and near(s["robots"][0], (1.5, 2, pi / 2), 1e-9))
    before = hands.state["robots"]
    hands.press("equal", "Return")  # what is not changed stays to the last digit
    assert hands.until(lambda s: s["prompt"] is None)["robots"] == before


def test_duplicate_undo_and_redo(open_editor):
    hands = open_editor(team((0, 0)))
    hands.click(0, 0)
    hands.press("ctrl+d")
    hands.until(lambda s: len(s["robots"]) == 2 and s["selection"] == [["robot", 1]])
    hands.press("ctrl+z")
    hands.until(lambda s: len(s["robots"]) == 1 and not s["changed"])
    hands.tool("p", "polygon")
    hands.click(-3, -3)
    hands.press("ctrl+z")  # takes a corner back of what is being drawn
    hands.until(lambda s: s["corners"] == 0)
    hands.press("ctrl+z")
    hands.until(lambda s: s["notice"] == "there is nothing to undo")
    hands.press("ctrl+y", "ctrl+z", "ctrl+shift+z")
    hands.until(lambda s: len(s["robots"]) == 2)
    hands.press("v", "Tab", "Delete")
    hands.until(lambda s: len(s["robots"]) == 1 and s["selection"] == [])
    hands.press("ctrl+z")
    hands.until(lambda s: s["selection"] == [["robot", 0]])


# -- what is wrong --------------------------------------------------------------------------------


def test_what_is_wrong_is_said_in_words_and_marked_and_not_saved(open_editor, tmp_path):
    hands = open_editor(team((-3, 0), (0, 0)))
    hands.drag((-3, 0), (-1, 0), (-0.4, 0))
    hands.until(lambda s: s["fault"] == "robot0 and robot1 overlap by 0.2 m")
    assert hands.state["culprits"] == [["robot", 0], ["robot", 1]]
    red = (0xA6, 0x1B, 0x1B)
    assert hands.shows(lambda seen: (seen[60:540] == red).all(axis=2).sum() > 40)
    before = (tmp_path / "given.toml").read_bytes()
    hands.press("ctrl+s")
    hands.until(lambda s: s["notice"] == "Not saved: robot0 and robot1 overlap by 0.2 m")
    hands.press("ctrl+q", "Return")  # the question stays, and says why
    hands.until(lambda s: s["error"] == "Not saved: robot0 and robot1 overlap by 0.2 m")
    assert (tmp_path / "given.toml").read_bytes() == before
    hands.press("Escape", "ctrl+z")
    hands.until(lambda s: s["fault"] == "" and not s["culprits"])


# -- keep -----------------------------------------------------------------------------------------


def test_saving_asks_for_a_name_once_and_before_it_overwrites(open_editor, tmp_path):
    (tmp_path / "room.toml").write_text("mine")
    hands = open_editor()
    hands.tool("r", "robot")
    hands.click(0, 0)
    hands.press("ctrl+s")
    hands.until(lambda s: s["prompt"] == "Save as" and s["typed"] == "scenario.toml")
    hands.fill("room")
    hands.until(lambda s: s["prompt"] == "room.toml is there already.")
    hands.press("Escape")
    assert (tmp_path / "room.toml").read_text() == "mine"
    hands.press("ctrl+s")
    hands.fill("room")
    hands.press("Return", "Escape", "Escape")
    hands.until(lambda s: ["Title", "Room"] in s["rows"] and not s["changed"])
    hands.press("r")
    hands.click(2, 2)
    hands.press("ctrl+s")
    hands.until(lambda s: s["notice"] == "Saved room.toml")
    saved = load_scenario(tmp_path / "room.toml")
    assert (saved.title, len(saved.robots)) == ("Room", 2)


def test_leaving_asks_when_something_would_be_lost(open_editor, tmp_path):
    hands = open_editor(team((0, 0)))
    hands.drag((0, 0), (1, 0), (2, 0))
    hands.press("Escape", "Escape")
    hands.until(lambda s: s["notice"] == "Ctrl Q closes the editor")
    hands.press("ctrl+q")
    hands.until(lambda s: s["prompt"] == "Not saved yet.")
    hands.press("Escape")
    hands.until(lambda s: s["prompt"] is None)
    hands.ask_to_close()
    hands.until(lambda s: s["prompt"] == "Not saved yet.")
    hands.ask_to_close()  # not asked a second time
    hands.until(lambda s: s.get("left"))
    hands = open_editor(tmp_path / "given.toml")
    hands.press("ctrl+q")
    hands.until(lambda s: s.get("left"))
    hands = open_editor(tmp_path / "given.toml")
    hands.drag((0, 0), (1, 0), (2, 0))
    hands.press("ctrl+q")
    hands.do("mousemove", *hands.state["menu"]["save"], "click", 1)
    hands.until(lambda s: s.get("left"))
    assert load_scenario(tmp_path / "given.toml").robots[0].pose == (2, 0, 0)


def test_f5_runs_the_file_in_this_window_and_comes_back(open_editor, monkeypatch):
    ran, run = [], lambda window, screen: ran.append((window, screen.get_size()))
    monkeypatch.setattr(display, "NOT_REAL", ())
    display._tried.clear()  # by whoever has asked for one before
    monkeypatch.setattr(PlayerWindow, "_loop", run)
    hands = open_editor(team((0, 0), stop_time=0.5))
    hands.resize(660, 520)
    hands.drag((0, 0), (1, 0), (2, 0))
    hands.press("F5")
    ((window, size),) = ran
    assert (window.player.frame.scenario.robots[0].pose, size) == ((2, 0, 0), (660, 520))
    hands.press("Delete")
    hands.until(lambda s: s["robots"] == [])


def test_what_can_not_be_asked_for_is_kept_in_a_new_file(open_editor):
    hands = open_editor(team((-3, 0), (0, 0)))
    assert hands.shown.dialogs.rescue() is None
    hands.drag((-3, 0), (-3, 1), (-3, 2))
    hands.drag((-3, 2), (-2, 1), (0, 0))  # on top of each other: that can't be saved
    hands.until(lambda s: s["fault"])
    kept = load_scenario(hands.shown.dialogs.rescue())
    assert kept.robots[0].pose == (-3, 2, 0)


# -- look -----------------------------------------------------------------------------------------


def test_the_wheel_zooms_the_middle_button_and_space_move_and_f_fits(open_editor):
    hands = open_editor(team((0, 0)))
    start = dict(hands.state)
    hands.do("mousemove", 500, 250, "click", 4, "click", 4)
    zoomed = hands.until(lambda s: s["scale"] > 1.3 * start["scale"])
    hands.do("mousemove", 300, 300, "mousedown", 2, "mousemove", 340, 280, "mouseup", 2)
    x, y = zoomed["origin"]
    hands.until(lambda s: near(s["origin"], (x + 40, y - 20), 0.1))
    hands.do("mousemove", 300, 300, "keydown", "space", "mousedown", 1, "mousemove", 310, 330)
    hands.do("mouseup", 1, "keyup", "space")
    hands.until(lambda s: near(s["origin"], (x + 50, y + 10), 0.1))
    assert hands.state["selection"] == []
    hands.press("f")
    hands.until(lambda s: s["scale"] == start["scale"] and s["origin"] == start["origin"])


def test_names_are_switched_and_looks_are(open_editor):
    hands = open_editor(team((0, 0)))
    before = hands.still()
    hands.press("i")
    assert hands.shows(lambda seen: differing(before, seen, np.s_[60:300]) > 100)
    hands.press("i", "d")
    assert hands.shows(lambda seen: seen[20, 400].max() < 60)
    hands.press("d", "z", "z", "z", "z")
    assert hands.shows(lambda seen: differing(before, seen) == 0)


# -- in a paused run ------------------------------------------------------------------------------


def test_a_paused_run_goes_on_from_now_with_what_was_moved_and_from_the_start_with_more(
    open_editor,
):
    hands = open_editor(team((0, 0)), live=True)
    hands.drag((0, 0), (1, 0), (2, 0))
    hands.tool("w", "wall")
    hands.click(-3, -3)
    hands.click(3, -3)
    hands.press("Return", "Return")
    left = hands.until(lambda s: s.get("left"))
    assert (left["when"], left["poses"]) == ("now", [[2, 0, 0]])
    hands = open_editor(team((0, 0)), live=True)
    hands.tool("r", "robot")
    hands.click(2, 2)
    hands.press("Return")
    hands.until(lambda s: "Shift+Enter" in s["notice"])
    hands.press("shift+Return")
    left = hands.until(lambda s: s.get("left"))
    assert (left["when"], len(left["poses"])) == ("start", 2)


def test_leaving_a_paused_run_asks_what_to_do_with_the_changes(open_editor):
    hands = open_editor(team((0, 0)), live=True)
    hands.drag((0, 0), (1, 0), (2, 0))
    hands.until(lambda s: s["robots"][0][0] == 2)
    hands.press("Escape", "Escape")
    hands.until(lambda s: s["prompt"] == "Use what was drawn?")
    hands.press("BackSpace")
    assert hands.until(lambda s: s.get("left"))["when"] is None


# -- the command ----------------------------------------------------------------------------------


@each_case(
    "arguments, words",
    [
        (["nowhere/room.toml"], "there is no folder nowhere"),
        (["rndom_walk"], "did you mean 'random_walk'?"),
        ([], "there is no display to draw on"),
    ],
)
def test_what_can_not_be_edited_is_said_in_one_line(
    tmp_path, monkeypatch, capsys, arguments, words
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert main(["edit", *arguments]) == 2
    said = capsys.readouterr().err
    assert words in said
    assert len(said.splitlines()) == 1


# -- references -----------------------------------------------------------------------------------


def test_it_looks_as_it_did(open_editor):
    pillar = [(0.8, -1.2), (2.6, -1.2), (2.6, 0.4)]
    hands = open_editor(
        team(
            (-3, -2, 0.8), (-3, 1),
            props=[Box(pose=(0, 2, 0.4), length=1.2, width=0.6)],
            addons=[Map([pillar], walls=[[(-4, -4), (4, -4), (4, 4), (-4, 4)]])],
        )
    )  # fmt: skip
    hands.click(1.9, -0.8)
    hands.until(lambda s: s["selection"] == [["outline", 0]])
    compare("editor_selected", hands.still())
    hands.tool("y", "waypoint")
    hands.click(-1, -3)
    hands.click(3, -3)
    hands.tool("p", "polygon")
    hands.click(2, 2)
    hands.click(3.5, 2)
    hands.point(3, 3.2)
    compare("editor_drawing", hands.still())
    hands.press("Escape", "Escape")
    hands.drag((-3, 1), (-3, 0), (-3, -1.6))
    hands.until(lambda s: s["fault"])
    compare("editor_fault", hands.still())
