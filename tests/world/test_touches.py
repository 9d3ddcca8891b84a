"""Touches while a world runs: add-ons are told of them, and they may end the run."""

from typing import ClassVar

import numpy as np
import pytest

import mars2d
from mars2d import Addon, Holonomic, InputError, Robot, Scenario
from mars2d.addons import Game, Map
from mars2d.bodies import Ball, Box
from mars2d.scenario.toml_file import read, save_scenario
from tests.cases import each_case


def ahead(robot):
    return 0.4, 0.0


class Touches(Addon):
    """Keeps what it is told of."""

    told: ClassVar[list] = []

    def on_contact(self, world, contact):
        names = [world.scenario.body_name(int(contact[side])) for side in "ab"]
        self.told.append((round(world.time, 3), *names, *contact[["began", "ended"]].tolist()))


def told(**scenario):
    Touches.told = []
    mars2d.run(Scenario(addons=[Touches()], sampling_time=0.1, **scenario))
    return Touches.told


def test_add_ons_are_told_when_two_meet_and_when_they_part():
    red = Robot(name="red", controller=ahead)
    ball = Ball(name="ball", pose=(0.5, 0, 0), restitution=0)
    still = Robot(name="red", pose=(0.5, 0.3, -np.pi / 2), controller=lambda r: (0.3, 0))
    assert told(robots=[red], props=[ball], stop_time=1.5) == [(0.7, "red", "ball", True, False)]
    bounced = told(robots=[still.at(0, 3)], props=[
        ball.replace(velocity=(1, 0, 0), restitution=1.0), ball.replace(name="b", pose=(1, 0, 0),
        restitution=1.0)], stop_time=1.0)  # fmt: skip
    assert bounced == [(0.4, "ball", "b", True, True)]

    def to_and_fro(robot):
        return (0.4 if robot.time < 1 else -0.4), 0.0

    box = Box(name="box", pose=(0.5, 0, 0), length=0.2, mass=5)
    events = told(robots=[red.replace(controller=to_and_fro)], props=[box], stop_time=3)
    assert [each[1:3] for each in events] == [("red", "box")] * len(events)
    assert events[0][3] is True
    assert events[-1][4] is True
    assert len(events) == 2  # not at each step in which they touch


GAME = Game({"pursuers": ["red"], "evaders": ["blue"]}, capture=0.01)
RED = Robot(name="red", pose=(-1, 0, 0), controller=ahead)
BLUE = Robot(name="blue", pose=(1, 0, np.pi), controller=ahead)
GREEN = Robot(name="green", pose=(-0.6, 0, 0))


@each_case(
    "stop_on, message",
    [
        (None, "blue was not caught in 9 s"),
        ("contact", "Contact: red and green touched at 0.25 s"),
        (("green", "red"), "Contact: red and green touched at 0.25 s"),
        ([("red", "blue"), ("blue", "green")], "Contact: blue and green touched at "),
        ([("pursuers", "evaders")], "blue was not caught in 9 s"),  # green is between them
        ([("evaders", "wall")], "blue was not caught in 9 s"),
    ],
)
def test_a_run_ends_with_a_touch(stop_on, message, tmp_path):
    scenario = Scenario(
        robots=[RED, BLUE, GREEN], addons=[GAME], stop_time=9, stop_on=stop_on, on_exit="wall"
    )
    record = mars2d.run(scenario)
    assert record.over_message.startswith(message)
    save_scenario(scenario.with_laws([None] * 3), tmp_path / "room.toml")
    assert read(tmp_path / "room.toml")[0].stop_on == scenario.stop_on


def test_roles_and_walls_are_known_by_their_names():
    pair = Scenario(robots=[RED, BLUE], addons=[GAME], stop_time=9, stop_on=("pursuers", "evaders"))
    assert mars2d.run(pair).over_message == "Contact: red and blue touched at 2.125 s"
    walled = Scenario(robots=[RED], addons=[Map([[(0, -1), (0, 1)]])], stop_on=("red", "wall"))
    assert mars2d.run(walled).over_message.startswith("Contact: red and obstacle 0 touched at 2.1")


@each_case(
    "value, message",
    [
        ("contacts", "expected 'contact', or pairs of names"),
        ([("red",)], "expected 'contact', or pairs of names"),
        (("red", "blu"), "Scenario.stop_on: nothing is called 'blu'; did you mean 'blue'?"),
        (("red", "wall"), "there is no wall; write on_exit='wall', or add a Map"),
        (("red", "red"), "nothing touches itself"),
    ],
)
def test_what_ends_no_run_is_refused(value, message):
    with pytest.raises(InputError) as caught:
        Scenario(robots=[RED, BLUE], stop_on=value)
    assert message in str(caught.value)


@each_case("step, aside, caught", [(1.0, 0.35, True), (0.25, 0.35, True), (1.0, 0.45, False)])
def test_who_passes_between_two_samples_is_caught(step, aside, caught):
    """The pursuer passes at 0.35 m, and is nowhere within 0.4 m at a sample of 1 s."""
    quick = Holonomic(max_linear_speed=2.0)
    red = Robot(name="red", pose=(-1, 0, 0), drive=quick, controller=lambda robot: (2.0, 0.0))
    blue = Robot(name="blue", pose=(0, aside, 0))
    game = Game({"pursuer": ["red"], "evader": ["blue"]}, capture=0.4)
    scenario = Scenario(robots=[red, blue], addons=[game], sampling_time=step, stop_time=2)
    record = mars2d.run(scenario)
    assert ("catches" in record.over_message) is caught
    outcome = game.outcome(record)
    assert bool(outcome.captures) is caught
    if caught:
        assert outcome.capture_time == pytest.approx(1.0 if step == 1.0 else 0.5)


def test_who_is_put_behind_another_by_hand_has_not_passed():
    game = Game({"pursuer": ["red"], "evader": ["blue"]}, capture=0.4)
    robots = [Robot(name="red", pose=(-2, 0, 0)), Robot(name="blue")]
    world = mars2d.World(Scenario(robots=robots, addons=[game]))
    world.step()
    world.operator.place("red", (2, 0, 0))
    world.step()
    world.step()
    assert world.addons.game.captures == ()
