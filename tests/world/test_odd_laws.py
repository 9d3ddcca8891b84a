"""Laws, sensors and add-ons that raise or return anything: always their error, the record kept."""

import asyncio
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import InputError, LawError, Robot, Scenario
from mars2d.addons import Addon
from mars2d.core.errors import Passing, UnknownNameError, class_name
from mars2d.core.usercode import Hangs, excerpt_of
from mars2d.sensors import Sensor
from mars2d.study.measures import measured
from mars2d.study.work import Failure
from mars2d.study.workers import attempt
from tests.cases import each_case


class NoArray:
    def __array__(self, *_, **__):
        raise RuntimeError("no array")


class NoText:
    def __str__(self):
        raise RuntimeError("no text")

    __repr__ = __str__


class NoItems:
    def __iter__(self):
        raise KeyError("no items")

    def __len__(self):
        raise OSError("no length")


class NoNumber:
    def __float__(self):
        raise OverflowError("no number")


class SilentError(Exception):
    def __str__(self):
        raise RuntimeError("no text")


class Own(BaseException):
    def __str__(self):
        return str(1 / 0)


class ClosedError(Exception):
    """An exception that answers nothing."""

    def __getattribute__(self, name):
        raise RuntimeError(name)


class Nameless(type):
    @property
    def __name__(cls):
        raise RuntimeError("no name")


class NamelessError(Exception, metaclass=Nameless):
    pass


class UnequalError(Exception):
    __hash__ = None

    def __eq__(self, other):
        raise RuntimeError("not compared")


class FrozenError(LawError):
    def __setattr__(self, name, value):
        raise RuntimeError("not set")


class LateError(Hangs):
    why = NoText()


def altered(**attributes):
    """Return a LawError to which a law has given attributes of its own."""
    error = LawError("mine")
    vars(error).update(attributes)
    return error


def in_a_circle():
    """Return an error that has caused itself."""
    one, other = ValueError("one"), ValueError("other")
    one.__cause__, other.__cause__ = other, one
    return one


RETURNED = [NoArray(), NoText(), NoItems(), NoNumber(), (NoArray(), NoText()), [[NoText()], [0]]]

RAISED = [
    SilentError(), Own(), asyncio.CancelledError(), GeneratorExit(), SystemExit(3),
    StopIteration(), RecursionError(), MemoryError(), OSError(28, "full"), Warning("w"),
    ExceptionGroup("several", [SilentError()]), UnicodeDecodeError("utf-8", b"x", 0, 1, "odd"),
    AttributeError(name="a", obj=NoText()), InputError(NoText()), in_a_circle(),
    ClosedError(), NamelessError(), UnequalError(), FrozenError("x"), LateError(), Passing("x"),
    LawError(), LawError(NoText()), UnknownNameError(NoText()), altered(where=NoText()),
    altered(where=5), altered(robot=NoText()), altered(time=NoText()), altered(time="now"),
    altered(record=5), altered(args=(NoText(),)),
]  # fmt: skip


def names(things):
    return [class_name(each) for each in things]


def acting(act):
    """Return a law that does something at 0.2 s."""

    def law(subject):
        return act() if subject.time > 0.15 else (0.0, 0.0)

    return law


def raising(error):
    def act():
        raise error

    return act


def failed(scenario, control=None):
    """Return the error of a run, which has kept its record."""
    with pytest.raises(LawError) as raised:
        mars2d.run(scenario, control=control)
    error = raised.value
    assert len(error.record) == 2
    assert error.record.over_message.startswith("Error: ")
    assert error.where.startswith("test_odd_laws.py, line ")
    assert "at 0.2 s)" in str(error)
    assert excerpt_of(error, Path(__file__)) is not None
    return error


RAISING = [pytest.param(raising(error), id=class_name(error)) for error in RAISED]
"""The functions that raise: pytest looks at the exceptions themselves, which some do not bear."""

RETURNING = [
    pytest.param(lambda each=each: each, id=name)
    for each, name in zip(RETURNED, names(RETURNED), strict=True)
]
ACTS = RETURNING + RAISING


@each_case("act", ACTS)
def test_a_law_of_a_robot(act):
    error = failed(Scenario(robots=[Robot(name="red", controller=acting(act))], stop_time=1))
    assert error.robot == "red"


@each_case("act", ACTS)
def test_a_law_of_a_team(act):
    failed(Scenario(stop_time=1), control=acting(act))


@each_case("act", RAISING)
def test_a_generator(act):
    def law(robot):
        yield 0.0, 0.0
        yield 0.0, 0.0
        act()

    failed(Scenario(robots=[Robot(controller=law)], stop_time=1))


@each_case("act", RAISING)
def test_a_sensor(act):
    class Odd(Sensor):
        def read(self, robot, world, rng):
            if world.time > 0.15:
                act()
            return 0.0

    said = failed(Scenario(robots=[Robot(name="red", sensors=[Odd()])], stop_time=1))
    assert said.robot == "red"


@each_case("value", [NoArray(), NoItems(), NoNumber()])
def test_a_reading(value):
    class Odd(Sensor):
        def read(self, robot, world, rng):
            return value if world.time > 0.15 else 0.0

    failed(Scenario(robots=[Robot(name="red", sensors=[Odd()])], stop_time=1))


@each_case("act", RAISING)
def test_an_addon(act):
    class Odd(Addon):
        def on_step(self, world):
            if world.time > 0.15:
                act()

    failed(Scenario(addons=[Odd()], stop_time=1))


class Odd(float):
    """A number that refuses to be one."""

    def __new__(cls, act):
        made = super().__new__(cls, 1.0)
        made.act = act
        return made

    def __float__(self):
        self.act()


@each_case("act", RAISING)
def test_a_measure(act):
    record = mars2d.run(Scenario(stop_time=1))
    with pytest.raises(LawError, match=r"odd (raised|returned)"):
        measured("odd", lambda _: Odd(act), record)


@each_case("act", RAISING)
def test_a_task_of_a_study(act):
    assert isinstance(attempt(lambda _: act(), None), Failure)


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
