"""The keys and the game controller that drive a robot, and who it is."""

import pygame
import pytest

from mars2d import Car, Holonomic, InputError, Omni, Robot, Scenario, Unicycle
from mars2d.addons import Game
from mars2d.cli.command_line import BAD_INPUT, main
from mars2d.scenario.roles import robots_named
from mars2d.window import show
from mars2d.window.run import driver as driver_module
from mars2d.window.run.driver import ARROWS, LETTERS, Driver
from mars2d.world.teleop import Stick, ramped
from tests.cases import each_case

UP, DOWN, LEFT, RIGHT = (
    pygame.KSCAN_UP, pygame.KSCAN_DOWN, pygame.KSCAN_LEFT, pygame.KSCAN_RIGHT
)  # fmt: skip
W, A, S, D = pygame.KSCAN_W, pygame.KSCAN_A, pygame.KSCAN_S, pygame.KSCAN_D


def key(code, down=True, mod=0):
    kind = pygame.KEYDOWN if down else pygame.KEYUP
    return pygame.event.Event(kind, scancode=code, key=0, unicode="", mod=mod)


@pytest.fixture
def driver(monkeypatch):
    monkeypatch.setattr(pygame.joystick, "init", lambda: None)
    return seated()


def seated():
    made = Driver()
    made.take(0, "red")
    return made


def settled(driver, drive):
    """The command once all ramps are over."""
    return driver.command(drive, 1.0)


# -- from a stick to a command ------------------------------------------------------------


@each_case(
    "stick, drive, command",
    [
        (Stick(1, 0), Holonomic(max_linear_speed=0.8), (0.8, 0.0)),  # where the arrow points
        (Stick(0, -0.5), Holonomic(max_linear_speed=0.8), (0.0, -0.4)),
        (Stick(0, 1), Unicycle(), (0.5, 0.0)),
        (Stick(-1, 0), Unicycle(), (0.0, 1.5)),  # it turns left
        (Stick(-0.5, 1), Car(max_steering=0.4, max_linear_speed=2.0), (2.0, 0.2)),
    ],
)
def test_a_stick_drives(stick, drive, command):
    assert stick.command(drive) == pytest.approx(command)


@each_case("drive", [Unicycle(), Unicycle(wheel_semiaxis=0.3)])
@each_case("stick", [Stick(1, 1), Stick(-1, 1), Stick(1, -1), Stick(0.3, 1)])
def test_full_speed_leaves_the_wheels_what_they_need_to_turn(drive, stick):
    v, omega = stick.command(drive)
    b = drive.wheel_semiaxis
    assert max(abs(v - b * omega), abs(v + b * omega)) <= drive.max_linear_speed + 1e-12
    assert omega == pytest.approx(-1.5 * stick.across)


def test_a_tap_is_a_nudge_and_a_stick_comes_back_sooner_than_it_goes_out():
    out = ramped(Stick(), Stick(0, 1), 0.05)
    assert out == pytest.approx(Stick(0, 0.2))
    assert ramped(out, Stick(), 0.05) == Stick()
    assert ramped(Stick(0, 0.5), Stick(0, 1, 1), 10.0) == Stick(0, 1, 1)
    assert ramped(Stick(0, 1), Stick(0, -1), 0.1) == pytest.approx(Stick(0, 0.2))


# -- keys -----------------------------------------------------------------------------------


@each_case(
    "keys, command",
    [
        ([DOWN], (0.0, -0.5)),
        ([A], (-0.5, 0.0)),
        ([RIGHT], (0.5, 0.0)),
        ([UP, W], (0.0, 0.5)),
        ([UP, DOWN], (0.0, 0.0)),
        ([UP, RIGHT], (0.5**1.5, 0.5**1.5)),
        ([], (0.0, 0.0)),
    ],
)
def test_keys_drive(monkeypatch, keys, command):
    monkeypatch.setattr(pygame.joystick, "init", lambda: None)
    driver = seated()
    for code in keys:
        assert driver.handle(key(code))
    assert settled(driver, Holonomic()) == pytest.approx(command)


def test_shift_halves_the_speed_as_soon_as_it_is_held(driver):
    driver.handle(key(UP))
    assert not driver.handle(key(pygame.KSCAN_LSHIFT, mod=pygame.KMOD_LSHIFT))
    assert settled(driver, Holonomic()) == (0.0, 0.25)
    driver.handle(key(pygame.KSCAN_LSHIFT, down=False))
    assert settled(driver, Holonomic()) == (0.0, 0.5)
    driver.take(0, "red")
    driver.handle(key(UP))
    assert driver.command(Holonomic(), 1 / 60) == pytest.approx((0.0, 0.5 * 4 / 60)), "a ramp"


def test_a_window_that_loses_the_keyboard_stops_the_robot(driver):
    driver.handle(key(UP, mod=pygame.KMOD_LSHIFT))
    assert not driver.handle(pygame.event.Event(pygame.WINDOWFOCUSLOST))
    assert settled(driver, Holonomic()) == (0.0, 0.0)


# -- controllers ----------------------------------------------------------------------------


class Controller:
    """A game controller as pygame shows it."""

    def __init__(self, number):
        self.number, self.axes, self.hat = number, [0.0, 0.0, 0.0], (0, 0)

    def get_instance_id(self):
        return 10 + self.number

    def get_axis(self, axis):
        return self.axes[axis]

    def get_numhats(self):
        return 1

    def get_hat(self, number):
        return self.hat


@pytest.fixture
def controller(driver, monkeypatch):
    made = Controller(0)
    monkeypatch.setattr(driver_module.pygame.joystick, "Joystick", lambda number: made)
    assert driver.handle(pygame.event.Event(pygame.JOYDEVICEADDED, device_index=0))
    return made


def tilt(controller, across, back):
    controller.axes[:2] = across, back


def test_a_robot_of_three_inputs_is_turned_by_keys_of_its_own_and_by_the_cross(controller, driver):
    q = key(pygame.KSCAN_Q)
    assert not driver.handle(q)  # which lists plots for a robot of two
    driver.take(0, "red", turns=True)
    assert driver.handle(key(UP))
    assert driver.handle(q)
    assert settled(driver, Omni()) == pytest.approx((0.5, 0.0, 1.5))
    driver.handle(key(UP, down=False))
    driver.handle(key(pygame.KSCAN_Q, down=False))
    driver.handle(pygame.event.Event(pygame.JOYDEVICEADDED, device_index=0))
    tilt(controller, 1.0, 0.0)
    controller.hat = (1, 0)
    assert settled(driver, Omni()) == pytest.approx((0.0, -0.5, -1.5))


def test_unplugged_it_stops_and_plugged_in_again_it_drives(driver, controller):
    tilt(controller, 0.0, -1.0)
    assert driver.handle(pygame.event.Event(pygame.JOYDEVICEREMOVED, instance_id=10))
    assert settled(driver, Holonomic()) == (0.0, 0.0)
    assert driver.status == "driving red"
    tilt(controller, 0.0, -1.0)  # a last word of it
    assert settled(driver, Holonomic()) == (0.0, 0.0)
    driver.handle(pygame.event.Event(pygame.JOYDEVICEADDED, device_index=0))
    tilt(controller, 0.0, 1.0)
    assert settled(driver, Holonomic()) == pytest.approx((0.0, -0.5))


def test_two_people_have_keys_and_controllers_of_their_own(monkeypatch):
    monkeypatch.setattr(pygame.joystick, "init", lambda: None)
    both = [Controller(0), Controller(1)]
    monkeypatch.setattr(driver_module.pygame.joystick, "Joystick", lambda number: both[number])
    one, two = Driver(ARROWS, 0, 2), Driver(LETTERS, 1, 2)
    people = {one: Holonomic(), two: Holonomic()}
    one.take(0, "red")
    two.take(1, "blue")

    def happens(event):
        return [person.handle(event) for person in people]

    def commands():
        return [settled(person, drive) for person, drive in people.items()]

    assert happens(key(UP)) == [True, False]
    assert happens(key(A)) == [False, True]
    assert commands() == [(0.0, 0.5), (-0.5, 0.0)]
    happens(key(UP, down=False))
    happens(key(A, down=False))
    for number, who in ((0, one), (1, two)):
        happens(pygame.event.Event(pygame.JOYDEVICEADDED, device_index=number))
        assert "controller" in who.status
        both[number].hat = (0, 1 - 2 * number)
    assert commands() == [(0.0, 0.5), (0.0, -0.5)]
    happens(pygame.event.Event(pygame.JOYDEVICEREMOVED, instance_id=10))
    assert commands() == [(0.0, 0.0), (0.0, -0.5)], "the other one keeps its person"
    assert "controller" not in one.status
    both.append(Controller(2))  # another one takes the free place
    happens(pygame.event.Event(pygame.JOYDEVICEADDED, device_index=2))
    both[2].hat = (1, 0)
    assert commands() == [(0.5, 0.0), (0.0, -0.5)]


# -- who --------------------------------------------------------------------------------------

ROBOTS = [Robot(name=name, pose=(k, 0, 0)) for k, name in enumerate(["red", "blue", "green"])]
GAME = Game({"pursuer": ["red"], "evader": ["green", "blue"]})


@each_case(
    "who, index",
    [("red", 0), ("blue", 1), ("2", 2), (2, 2), ("pursuer", 0), ("evader", 2)],
)
def test_a_robot_is_named_by_its_name_its_index_or_a_role(who, index):
    assert robots_named(Scenario(robots=ROBOTS, addons=[GAME]), who, "human =") == (index,)


def test_who_names_a_role_gets_its_next_robot():
    scenario = Scenario(robots=ROBOTS, addons=[GAME])
    assert robots_named(scenario, ["evader", "evader"], "--role") == (2, 1)
    for named, words in [
        (["pursuer", "pursuer"], "--role pursuer: somebody drives its robot already"),
        (["evader", "green"], "--role green: somebody drives its robot already"),
        (["0", "1", "2"], "--role 0, 1, 2: two people at most"),
    ]:
        with pytest.raises(InputError, match=words):
            robots_named(scenario, named, "--role")
    assert robots_named(scenario, None, "--role") == ()


@each_case(
    "who, words",
    [
        ("evadr", "human = evadr: there is no such robot or role; did you mean 'evader'?"),
        ("3", "human = 3: there is no such robot or role; known: blue, evader, green"),
        (-1, "human = -1: there is no such robot or role"),
    ],
)
def test_nobody_of_that_name_is_an_error_with_the_nearest(who, words):
    with pytest.raises(InputError) as raised:
        robots_named(Scenario(robots=ROBOTS, addons=[GAME]), who, "human =")
    assert str(raised.value).startswith(words)


# -- on the command line --------------------------------------------------------------------------


@pytest.fixture
def shown(monkeypatch):
    """What the window was opened with, in place of the window."""
    found = []

    def show_experiment(experiment, speed, *_, humans=(), **__):
        found.append((speed, humans))
        raise InputError("that is all")

    monkeypatch.setattr(show, "show_experiment", show_experiment)
    monkeypatch.setattr("mars2d.cli.runs.display_available", lambda: True)
    return found


@each_case(
    "arguments, speed, humans",
    [
        ([], 20.0, ()),
        (["--human", "evader"], 1.0, (1,)),
        (["--human", "evader", "--human", "0"], 1.0, (1, 0)),
        (["--human", "0", "--speed", "7"], 7.0, (0,)),
        (["--human", "red", "--set", "animation.playback_speed=max"], 1.0, (0,)),
    ],
)
def test_somebody_who_drives_is_not_in_a_hurry(shown, arguments, speed, humans, capsys):
    assert main(["run", "pursuit_corners", *arguments]) == BAD_INPUT
    assert "that is all" in capsys.readouterr().err
    assert shown.pop() == (speed, humans)


@each_case(
    "roles, humans",
    [
        (["--role", "evader"], (1,)),
        (["--role", "evader", "--role", "pursuer"], (1, 0)),
        (["--role", "pursuer,evader"], (0, 1)),
        ([], ()),
    ],
)
def test_play_seats_people_in_their_order(shown, roles, humans):
    assert main(["play", "corner_game", *roles]) == BAD_INPUT
    assert shown.pop() == (1.0, humans)


@each_case(
    "arguments, words",
    [
        (["--human", "evadr"], "--human evadr: there is no such robot or role; did you mean"),
        (["--human", "evader"], "--human evader: driving by hand needs a window, and there is no"),
        (["--human", "1", "--headless"], "--human 1: driving by hand needs a window, not --head"),
    ],
)
def test_where_nobody_can_drive_this_is_said_at_once(monkeypatch, capsys, arguments, words):
    monkeypatch.setattr("mars2d.cli.runs.display_available", lambda: False)
    assert main(["run", "pursuit_corners", *arguments]) == BAD_INPUT
    assert words in capsys.readouterr().err
