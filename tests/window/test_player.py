"""The clock of the window: speeds, steps, pauses, and what is drawn in between."""

from dataclasses import replace

import numpy as np
import pygame
import pytest

from mars2d.core.errors import LawError
from mars2d.window.run import keys
from mars2d.window.screen.player import SPEEDS, Player, between
from mars2d.window.widgets.actions import action_of
from tests.cases import each_case
from tests.window.circling import Circling, circling_scenario


class Clock:
    """A wall clock that moves when told to, and by `tick` each time it is read."""

    def __init__(self, tick=0.0):
        self.now, self.tick = 0.0, tick

    def __call__(self):
        self.now += self.tick
        return self.now


def player(speed=1.0, clock=None, **source):
    return Player(Circling(**source), speed, clock=clock or Clock())


def play(player, seconds, pictures_a_second=60):
    for _ in range(round(seconds * pictures_a_second)):
        player.pass_time(1 / pictures_a_second)


@each_case("speed", [0.5, 1, 3])
def test_simulated_time_is_speed_times_wall_time(speed):
    p = player(speed)
    play(p, 2.0)
    assert p.frame.time == pytest.approx(2.0 * speed)


def test_long_sampling_times_are_drawn_in_between():
    p = player(1.0, scenario=circling_scenario(sampling_time=1.0), rows=100)
    play(p, 1.5)
    frame = p.frame
    assert frame.time == pytest.approx(1.5)
    assert frame.iteration == 1
    np.testing.assert_allclose(frame.pose, (p.source.path[1] + p.source.path[2]) / 2)
    assert len(frame.path) == 2
    assert p.source.row == 2  # never more than one sampling time ahead


def test_a_pause_shows_the_present_frame_and_lasts():
    p = player(1.0, scenario=circling_scenario(sampling_time=1.0))
    play(p, 1.5)
    p.pause_or_resume()
    assert p.status() == ("paused", "waiting")
    assert p.frame.time == 2.0
    play(p, 1.0)
    assert p.frame.time == 2.0
    p.pause_or_resume()
    play(p, 0.5)
    assert p.frame.time == pytest.approx(2.5)


def test_manual_mode_goes_by_steps_only():
    p = player(0)
    play(p, 1.0)
    assert p.source.row == 0
    assert p.status() == ("manual", "waiting")
    p.step()
    p.pause_or_resume()
    assert p.source.row == 2
    assert p.status() == ("manual", "waiting")
    p.faster()
    assert p.speed == SPEEDS[0]
    assert p.playing


def test_plus_and_minus_climb_the_ladder():
    p = player(1.0)
    seen = []
    for _ in range(9):
        p.faster()
        seen.append(p.status()[0])
    assert seen == ["2x", "5x", "10x", "20x", "50x", "100x", "max", "max", "max"]
    for _ in range(20):
        p.slower()
    assert p.status()[0] == "0.1x"
    odd = player(3.0)
    odd.faster()
    assert odd.speed == 5.0
    odd = player(3.0)
    odd.slower()
    assert odd.speed == 2.0


def test_at_max_as_many_steps_as_fit_are_done_between_two_pictures():
    clock = Clock(tick=0.001)
    p = Player(Circling(), "max", budget=0.014, clock=clock)
    p.pass_time(1 / 60)
    assert 12 <= p.source.row <= 15
    assert p.frame.iteration == p.source.row


def test_a_simulation_that_is_too_slow_does_not_pile_up_a_debt():
    clock = Clock(tick=0.014)  # each reading of the clock costs a whole picture's time
    p = Player(Circling(rows=1000), 100.0, budget=0.014, clock=clock)
    for _ in range(60):
        p.pass_time(1 / 60)
        clock.now += 1 / 60
    assert p.source.row == 60
    assert p.frame.time == pytest.approx(6.0)
    text, kind = p.status()
    assert kind == "running"
    assert text.startswith("100x  reaches ")
    assert 1 < float(text.split()[-1].removesuffix("x")) < 20


def test_over_is_told_once_the_last_frame_is_shown():
    p = player(1.0, rows=3)
    play(p, 0.25)
    assert p.source.over
    assert not p.over
    assert p.frame.over_message == ""
    play(p, 0.1)
    assert p.over
    assert p.frame.over_message == "the circle is closed"
    assert p.status() == ("over", "waiting")
    p.step()
    assert p.source.row == 3


@each_case("speed", [0, 1.0, "max"])
def test_a_law_that_fails_stops_time_and_is_kept(speed):
    p = player(speed, fails_at=2)
    for _ in range(5):
        p.step() if speed == 0 else play(p, 0.5)
    assert isinstance(p.error, LawError)
    assert p.over
    assert p.status() == ("stopped", "error")
    assert p.frame.iteration == 2
    p.restart()
    assert p.error is None
    assert p.frame.iteration == 0


def test_between_two_frames_props_move_and_contacts_are_those_under_way():
    source = Circling(pressed=True)
    source.row = 4
    first = replace(source.frame, prop_pose=np.zeros((3, 1)))
    source.row = 5
    second = replace(source.frame, prop_pose=np.full((3, 1), 2.0))
    seen = between(first, second, 0.45)
    np.testing.assert_allclose(seen.prop_pose, np.full((3, 1), 1.0))
    np.testing.assert_array_equal(seen.contacts, second.contacts)
    assert len(seen.contact_log()) == len(seen.path) == 5


# -- keys -----------------------------------------------------------------------------------------


def test_every_key_has_its_own_command():
    labels = [label for each in keys.ACTIONS for label in (*each.labels, *each.also)]
    assert len(labels) == len(set(labels))
    assert len({each.name for each in keys.ACTIONS}) == len(keys.ACTIONS)
    assert all(each.help and each.labels for each in (*keys.ACTIONS, *keys.MOUSE))


def pressed(name, character, mod=0):
    code = pygame.key.key_code(name)
    event = pygame.Event(pygame.KEYDOWN, key=code, unicode=character, mod=mod)
    action = action_of(event, keys.ACTIONS)
    return None if action is None else action.name


@each_case(
    "name, character, action",
    [
        ("space", " ", "pause"), ("right", "", "step"), ("=", "=", "faster"), ("=", "+", "faster"),
        ("]", "+", "faster"), ("[+]", "+", "faster"), ("-", "-", "slower"), ("f1", "", "help"),
        ("escape", "", "escape"), ("w", "w", "push"), ("left shift", "", None),
        ("return", "", None),
    ],
)  # fmt: skip
def test_what_keys_do(keyboard, name, character, action):
    assert pressed(name, character) == action


@each_case(
    "name, mod, action",
    [
        ("=", pygame.KMOD_LSHIFT, "nearer"), ("=", 0, "nearer"), ("-", 0, "farther"),
        ("[+]", 0, "nearer"), ("0", 0, "fit"), ("w", 0, "leave"), ("x", 0, None),
    ],
)  # fmt: skip
def test_what_keys_do_with_ctrl(keyboard, name, mod, action):
    assert pressed(name, "", mod | pygame.KMOD_LCTRL) == action


def test_so_many_steps_are_done_as_pictures_allow_and_then_it_is_paused():
    p = player(1.0, clock=Clock(tick=0.004), rows=100)
    p.step(40)
    assert 0 < p.source.row < 40  # a picture waits for no more than its budget
    assert p.status()[0].endswith("steps")
    play(p, 1.0)
    assert p.source.row == 40
    assert p.status() == ("paused", "waiting")
    assert p.frame.time == pytest.approx(4.0)


def test_one_can_go_back_and_on_again_through_what_was_run():
    p = player(1.0, rows=50)
    p.step(20)
    p.back()
    assert (p.source.row, p.past, p.frame.iteration) == (19, True, 19)
    assert p.status() == ("past  0.1 s ago", "past")
    p.back(100)
    assert p.source.row == 0
    p.step(15)
    assert (p.source.row, p.source.newest) == (15, 20)
    p.pause_or_resume()
    play(p, 1.0)
    assert p.source.newest > 20  # it has gone on beyond what was run before
    assert not p.past


def test_the_past_of_a_law_that_failed_can_be_looked_at():
    p = player(1.0, fails_at=5)
    p.step(10)
    assert p.failed
    assert p.over
    p.go(2)
    assert not p.failed
    assert not p.over
    assert p.error is not None
    p.step(10)
    assert p.failed


def test_at_speed_max_the_simulation_gets_nine_times_as_long_as_the_drawing():
    p = player("max", clock=Clock(tick=0.001), rows=1000)
    p.pass_time(0.016)
    quick = p.source.row
    p.drawing = 0.01
    p.pass_time(0.016)
    assert p.source.row - quick > 4 * quick


# -- contacts -------------------------------------------------------------------------------------


def test_at_speed_max_it_stops_at_the_step_of_the_contact_too():
    p = Player(Circling(rows=50, pressed=True), "max")
    p.stops = True
    p.pass_time(0.1)
    assert (p.source.row, p.paused) == (1, True)
    p.pause_or_resume()
    while p.playing:
        p.pass_time(0.1)
    assert p.source.row == 50
