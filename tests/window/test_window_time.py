"""Time in the window: paused, step by step, back and on, slower and faster, other branches."""

import pygame
import pytest

from tests.window.person import HEADER, PLOT, differing
from tests.window.test_window_buttons import choose, offered


def test_arrows_repeat_when_held(open_window):
    window = open_window(1)
    window.press("Right")
    first = window.until(lambda s: s["status"] == "paused")
    window.do("keydown", "Right")
    window.until(lambda s: s["row"] > first["row"] + 4)
    window.do("keyup", "Right")
    stopped = window.settle()["row"]
    window.do("sleep", 0.2)
    assert window.settle()["row"] == stopped
    window.do("keydown", "Left")
    window.until(lambda s: s["row"] < stopped - 3)
    window.do("keyup", "Left")


def test_keys_go_on_and_back_by_ten_steps_and_to_the_ends(open_window):
    window = open_window(1, rows=1000)
    window.press("space")
    start = window.until(lambda s: s["status"] == "paused")["row"]
    window.press("Next")
    window.until(lambda s: s["row"] == start + 10)
    window.press("Prior")
    window.until(lambda s: s["row"] == start)
    window.press("Home")
    window.until(lambda s: s["row"] == 0 and s["past"])
    window.press("End")
    window.until(lambda s: s["row"] == start + 10 and not s["past"])


def test_plus_and_minus_and_the_slider_change_the_speed_that_is_shown(open_window):
    window = open_window(1, rows=200_000)
    before = window.look()
    window.press("plus")
    window.until(lambda s: s["speed"] == "2.0" and s["status"] == "2x")
    assert window.shows(lambda seen: differing(before, seen, HEADER) > 20)
    window.press("minus", "minus", "minus")
    window.until(lambda s: s["speed"] == "0.2")
    window.press(*["KP_Add"] * 9)
    window.until(lambda s: s["speed"] == "inf" and s["status"].startswith("max"))
    left, right, y = window.state["slider"]
    window.slide((right, y), ((left + right) // 2, y), (left, y), drop=False)
    window.until(lambda s: s["speed"] == "0.1")
    window.slide((left, y), (left + (right - left) * 3 // 10, y - 100))  # it stays in the hand
    window.until(lambda s: s["speed"] == "1.0")
    assert window.settle()["origin"] == pytest.approx(window.state["origin"])
    window.do("mousemove", right, y)
    window.settle()
    window.do("click", 1)
    window.until(lambda s: s["speed"] == "inf")


def test_the_time_bar_is_clicked_and_dragged_to_look_back(open_window):
    window = open_window(50, rows=400)
    window.until(lambda s: s["over"])
    first, last, y = window.state["bar"]
    x = round((first + last) / 2)
    window.do("mousemove", x, y, "click", 1)
    window.until(lambda s: abs(s["row"] - 200) <= 1 and s["past"])
    assert window.state["selected"] is None
    seen = set()
    window.do("mousedown", 1)
    for k in range(1, 6):
        window.do("mousemove", round(x - k * (x - first) / 5), y - 40)  # beside it, still held
        seen.add(window.settle()["row"])
    window.do("mouseup", 1)
    assert len(seen) == 5
    assert window.settle()["row"] == 0
    window.do("mousemove", 300, 300)
    assert window.settle()["row"] == 0
    window.press("space")
    window.until(lambda s: s["row"] > 3 and s["playing"])


# -- a live experiment ----------------------------------------------------------------------------


def test_a_change_in_the_past_makes_a_branch_and_b_goes_to_the_other_one(open_window, room):
    window = open_window(20, experiment=str(room))
    window.until(lambda s: s["newest"] >= 60)
    window.press("space", "Home")
    window.steps(30)
    window.until(lambda s: s["row"] == 30 and s["past"] and s["branches"] == 0)
    newest, before = window.state["newest"], window.state["robots"][0]
    window.drag((-2, -1), (-1.5, -1.2), (-1, -1.5))
    window.until(lambda s: s["branches"] == 1 and s["newest"] == 30)
    there = window.state["robots"][1][:2]
    assert there == pytest.approx((-1, -1.5), abs=0.05)
    assert window.state["robots"][0] == before
    window.steps(20)
    window.until(lambda s: s["newest"] == 50)
    assert window.state["marks"]["branch"] == [30]
    assert window.state["marks"]["hand"] == [30]
    seen = window.still()
    window.press("b")
    window.until(lambda s: s["newest"] == newest and s["row"] == 50)
    assert window.state["robots"][1][:2] == [-2, -1]
    assert window.shows(lambda now: differing(seen, now) > 100)
    window.press("b")
    window.until(lambda s: s["newest"] == 50 and s["robots"][1][:2] == there)
    window.press("b", "space")  # time goes on in the one that is seen
    window.until(lambda s: s["newest"] > newest)


LAW = """
def ahead(robot):
    if robot.pose[0] > -1.5:
        raise ValueError("I am lost")
    return 0.2, 0.0
"""


def test_where_a_law_fails_its_line_is_shown_and_the_past_can_be_looked_at(open_window, room):
    text = room.read_text()
    start = text.index("\n\ndef ahead")
    room.write_text(text[:start] + LAW + text[text.index("\n\ndef scenario") :])
    line = room.read_text().splitlines().index('        raise ValueError("I am lost")') + 1
    window = open_window("max", experiment=str(room))
    window.until(lambda s: s["status"] == "stopped")
    assert "I am lost" in window.state["banner"]
    assert window.state["line"] == line
    assert window.state["marks"]["error"] == [window.state["newest"]]
    x0, x1, y = window.state["bar"]
    window.do("mousemove", round((x0 + x1) / 2), y, "click", 1)
    half = window.state["newest"] // 2
    window.until(lambda s: abs(s["row"] - half) <= 1 and s["banner"] is None)
    assert window.state["robots"][0][0] < -1.6
    window.press("End")
    window.until(lambda s: s["banner"] is not None)
    window.press("r")
    window.until(lambda s: s["newest"] == 0)
    window.press("space")
    window.until(lambda s: s["status"] == "stopped")
    window.press("ctrl+q")
    window.until(lambda s: "raised" in s)
    assert "I am lost" in window.state["raised"]


def test_a_file_with_fewer_robots_starts_anew_whatever_was_selected(open_window, room):
    window = open_window(1, experiment=str(room))
    window.point(1, -1)
    window.until(lambda s: s["over_body"] == 2)
    window.press("Tab", "Tab", "h", "l")
    window.until(lambda s: (s["driving"], s["selected"], s["following"]) == (1, 1, True))
    window.press("Tab")
    window.until(lambda s: s["selected"] == 2)
    text = room.read_text().replace("[red, blue]", "[red]").replace("props=[crate],", "")
    room.write_text(text)
    window.until(lambda s: len(s["robots"]) == 1 and not s["props"])
    row = window.settle()["row"]
    window.until(lambda s: s["row"] > row)
    assert (window.state["driving"], window.state["selected"]) == (None, None)


# -- a recording ----------------------------------------------------------------------------------


@pytest.fixture
def recording(room, tmp_path):
    from mars2d.scenario.experiment import open_experiment
    from mars2d.world.loop import simulate

    path = tmp_path / "room.npz"
    simulate(open_experiment(room, {"stop_time": 6.0}, seed=1)).record.save(path)
    return path


def test_a_recording_can_be_looked_at_and_says_what_can_not_be_done(open_window, recording):
    window = open_window(2, record=str(recording))
    window.until(lambda s: s["time"] > 0.5)
    window.press("space", "End")
    newest = window.until(lambda s: s["row"] == s["newest"])["newest"]
    assert window.state["over"]
    window.press("Left", "Prior")
    window.until(lambda s: s["row"] == newest - 11)
    x0, x1, y = window.state["bar"]
    window.do("mousemove", round((x0 + x1) / 2), y, "click", 1)
    window.until(lambda s: abs(s["row"] - newest / 2) <= 1)
    robots = window.settle()["robots"]
    changing = {"drive", "edit", "restart", "branch", "parameters"}
    assert not changing & window.state["buttons"].keys()
    for key in ("h", "e", "b", "F2"):
        said = window.state["said"]
        window.press(key)
        window.until(lambda s, said=said: s["said"] == said + 1)
        window.says("this is a recording")
    window.drag((-2, -1), (-1, -1.5))
    window.until(lambda s: s["said"] == said + 2)
    assert window.settle()["robots"] == robots
    assert (window.state["driving"], window.state["editor"]) == (None, None)
    window.press("q")
    choose(window, "Kinetic energy")
    window.until(lambda s: "kinetic energy" in s["areas"])
    window.press("Escape")
    window.until(lambda s: not s["menu"])
    assert offered(window, -2, -1) == {"Follow with the camera", "Plot over time"}
    window.press("Escape", "r")
    window.until(lambda s: s["row"] == 0 or s["playing"])
    assert window.look()[PLOT].mean() > 200


def test_while_a_law_takes_long_esc_breaks_it_off_and_ctrl_q_closes_the_window(open_window):
    shown = open_window(0).shown
    for key, mod, how in (
        (pygame.K_x, 0, ""),
        (pygame.K_ESCAPE, 0, "did not return before Esc was pressed"),
        (pygame.K_q, pygame.KMOD_LCTRL, "did not return before the window was closed"),
    ):
        assert shown._open
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=key, mod=mod, unicode=""))
        assert shown._answer("walk.py, line 6") == how
    assert not shown._open


def test_a_law_that_waits_in_c_is_named_and_only_ctrl_q_ends_it(open_window):
    shown = open_window(0).shown
    shown._limit.blocked, shown._passing = True, True
    pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_ESCAPE, mod=0, unicode=""))
    assert shown._answer("walk.py, line 6") == "", "nothing can break it off"
    notes = [note.text for note in shown.notes._notes]
    assert notes == ["waiting for walk.py, line 6; Ctrl Q ends the program, and saves"]
    pygame.event.post(pygame.Event(pygame.QUIT))
    assert shown._answer("walk.py, line 6") == "did not return before the window was closed"


def test_shift_and_arrows_go_through_a_step_moment_by_moment_and_on_to_the_next(open_window, room):
    window = open_window(1, experiment=str(room))
    window.press("space", "Home", "Right", "Right", "Right")
    row, x = window.state["row"], window.state["robots"][0][0]
    window.press(*["shift+Right"] * 3)
    moment = window.shown.player.frame
    assert moment.time == pytest.approx(0.1 * row + 3 * 0.1 / 8)
    assert moment.pose[0, 0] == pytest.approx(x + 0.2 * 3 * 0.1 / 8)
    assert window.settle()["chip"] == "+37.5 ms  3 of 8"
    assert window.state["layers"]["forces"]
    window.press(*["shift+Right"] * 6)  # beyond the end of the step
    assert window.shown.player.frame.time == pytest.approx(0.1 * (row + 1) + 0.1 / 8)
    window.press(*["shift+Left"] * 2)  # the row itself, then the step before
    assert window.shown.player.frame.time == pytest.approx(0.1 * (row + 1) - 0.1 / 8)
    window.press("Right")
    assert window.settle()["chip"] == "paused"
