"""Laws, sensors and add-ons that raise or return anything: always their error, the record kept."""

import asyncio

import numpy as np
import pytest

import mars2d
from mars2d import InputError, LawError, Robot, Scenario
from mars2d.addons import Addon
from mars2d.sensors import Sensor
from mars2d.study.measures import measured
from mars2d.study.work import Failure
from mars2d.study.workers import attempt


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


RETURNED = [NoArray(), NoText(), NoItems(), NoNumber(), (NoArray(), NoText()), [[NoText()], [0]]]

RAISED = [
    SilentError(), Own(), asyncio.CancelledError(), GeneratorExit(), SystemExit(3),
    StopIteration(), RecursionError(), MemoryError(), OSError(28, "full"), Warning("w"),
    ExceptionGroup("several", [SilentError()]), UnicodeDecodeError("utf-8", b"x", 0, 1, "odd"),
    AttributeError(name="a", obj=NoText()), InputError(NoText()),
]  # fmt: skip


def names(things):
    return [type(each).__name__ for each in things]


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
    return error


ACTS = [lambda each=each: each for each in RETURNED] + [raising(error) for error in RAISED]


@pytest.mark.parametrize("act", ACTS, ids=names(RETURNED + RAISED))
def test_a_law_of_a_robot(act):
    error = failed(Scenario(robots=[Robot(name="red", controller=acting(act))], stop_time=1))
    assert error.robot == "red"


@pytest.mark.parametrize("act", ACTS, ids=names(RETURNED + RAISED))
def test_a_law_of_a_team(act):
    failed(Scenario(stop_time=1), control=acting(act))


@pytest.mark.parametrize("error", RAISED, ids=names(RAISED))
def test_a_generator(error):
    def law(robot):
        yield 0.0, 0.0
        yield 0.0, 0.0
        raise error

    failed(Scenario(robots=[Robot(controller=law)], stop_time=1))


@pytest.mark.parametrize("error", RAISED, ids=names(RAISED))
def test_a_sensor(error):
    class Odd(Sensor):
        def read(self, robot, world, rng):
            if world.time > 0.15:
                raise error
            return 0.0

    said = failed(Scenario(robots=[Robot(name="red", sensors=[Odd()])], stop_time=1))
    assert said.robot == "red"


@pytest.mark.parametrize("value", [NoArray(), NoItems(), NoNumber()], ids=names(RETURNED[:3]))
def test_a_reading(value):
    class Odd(Sensor):
        def read(self, robot, world, rng):
            return value if world.time > 0.15 else 0.0

    failed(Scenario(robots=[Robot(name="red", sensors=[Odd()])], stop_time=1))


@pytest.mark.parametrize("error", RAISED, ids=names(RAISED))
def test_an_addon(error):
    class Odd(Addon):
        def on_step(self, world):
            if world.time > 0.15:
                raise error

    failed(Scenario(addons=[Odd()], stop_time=1))


class Odd(float):
    """A number that refuses to be one."""

    def __new__(cls, error):
        made = super().__new__(cls, 1.0)
        made.error = error
        return made

    def __float__(self):
        raise self.error


@pytest.mark.parametrize("error", RAISED, ids=names(RAISED))
def test_a_measure(error):
    record = mars2d.run(Scenario(stop_time=1))
    with pytest.raises(LawError, match=r"odd (raised|returned)"):
        measured("odd", lambda _: Odd(error), record)


@pytest.mark.parametrize("error", RAISED, ids=names(RAISED))
def test_a_task_of_a_study(error):
    assert isinstance(attempt(lambda _: raising(error)(), None), Failure)


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
