"""Laws, sensors and add-ons that raise: always their error, at their line, the record kept."""

from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, LawError, Robot, Scenario
from mars2d.addons import Addon
from mars2d.output.excerpt import excerpt_of
from mars2d.sensors import Sensor
from mars2d.study.measures import measured
from mars2d.study.work import Failure
from mars2d.study.workers import attempt
from tests.cases import each_case

RAISED = [
    ZeroDivisionError("x"), StopIteration(), RecursionError(), MemoryError(), OSError(28, "full"),
    ExceptionGroup("several", [ValueError("x")]), UnicodeDecodeError("utf-8", b"x", 0, 1, "odd"),
    InputError("x"), LawError("x"),
]  # fmt: skip

each_error = each_case("error", RAISED)


def failed(scenario, control=None):
    """Return the error of a run that failed at 0.2 s, and has kept its record."""
    with pytest.raises(LawError) as raised:
        mars2d.run(scenario, control=control)
    error = raised.value
    assert len(error.record) == 2
    assert error.record.over_message.startswith("Error: ")
    assert error.where.startswith("test_odd_laws.py, line ")
    assert "at 0.2 s)" in str(error)
    assert excerpt_of(error, Path(__file__)) is not None
    return error


@each_error
def test_a_law_of_a_robot_or_a_team(error):
    def law(subject):
        if subject.time > 0.15:
            raise error
        return 0.0, 0.0

    said = failed(Scenario(robots=[Robot(name="red", controller=law)], stop_time=1))
    assert said.robot == "red"
    failed(Scenario(stop_time=1), control=law)


@each_error
def test_a_generator(error):
    def law(robot):
        yield 0.0, 0.0
        yield 0.0, 0.0
        raise error

    failed(Scenario(robots=[Robot(controller=law)], stop_time=1))


@each_error
def test_a_sensor(error):
    class Odd(Sensor):
        def read(self, robot, world, rng):
            if world.time > 0.15:
                raise error
            return 0.0

    said = failed(Scenario(robots=[Robot(name="red", sensors=[Odd()])], stop_time=1))
    assert said.robot == "red"


@each_error
def test_an_addon(error):
    class Odd(Addon):
        def on_step(self, world):
            if world.time > 0.15:
                raise error

    failed(Scenario(addons=[Odd()], stop_time=1))


@each_error
def test_a_measure_and_a_task_of_a_study(error):
    def act(_):
        raise error

    with pytest.raises(LawError, match=r"odd raised|: x"):
        measured("odd", act, mars2d.run(Scenario(stop_time=1)))
    assert isinstance(attempt(act, None), Failure)


def test_ctrl_c_is_no_error_of_the_law():
    def law(robot):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        mars2d.run(Scenario(robots=[Robot(controller=law)], stop_time=1))


def test_numbers_of_other_kinds_are_numbers():
    class Real(float):
        pass

    record = mars2d.run(Scenario(stop_time=1), control=lambda world: (Real(0.2), np.float32(0)))
    assert record.finished
