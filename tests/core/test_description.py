"""Descriptions are frozen, and nothing wrong gets into one."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mars2d import InputError
from mars2d.core.description import Description, choice, entry, flag, integer, number, text
from tests.cases import each_case

NAN, INF = float("nan"), float("inf")


class Motor(Description):
    power: float = number(default=1.0, above=0, high=100, unit="W")
    share: float = number(default=0.5, low=0, high=1)
    limit: float | None = number(default=None, optional=True, low=0)
    poles: int = integer(default=4, low=2, high=64)
    kind: str = choice(default="direct", of=("direct", "geared"))
    on: bool = flag(default=True)
    label: str = text(default="motor")
    plain: float = 2.0
    count: int = 1
    word: str = ""
    switch: bool = False


class Wheel(Description):
    motor: Motor = entry(check=lambda _name, value: value, kw_only=False)
    radius: float = number(above=0)


@each_case(
    "value",
    [NAN, INF, -INF, "0.5", None, True, 1j, [0.5], (), {}, b"1", 10**400, -(10**400), ...,
     np.float64(NAN), np.array([0.5]), np.complex128(1), np.bool_(True), Motor],
)  # fmt: skip
@each_case("field", ["power", "share", "plain"])
def test_what_is_no_finite_number_is_refused(field, value):
    with pytest.raises(InputError, match=f"^Motor.{field} = "):
        Motor(**{field: value})


@given(st.floats(allow_nan=True, allow_infinity=True))
def test_a_number_is_within_its_bounds_or_refused(value):
    try:
        motor = Motor(power=value)
    except InputError:
        assert not 0 < value <= 100
    else:
        assert 0 < motor.power <= 100


@each_case(
    ("field", "good", "bad"),
    [
        ("power", [1e-300, 100], [0, -1, 100.0001]),
        ("share", [0, 1], [-1e-300, 1.0000001]),
        ("limit", [None, 0], [-1, "None"]),
        ("poles", [2, 64], [1, 65, 4.0, True, "4", None, 10**400]),
        ("kind", ["direct", "geared"], ["Direct", "", None, 1, ["direct"]]),
        ("on", [True, False], [0, 1, "True", None, []]),
        ("label", ["", "x"], [None, 1, b"x", ["x"]]),
        ("count", [0, -5], [1.0, "1", True, None]),
        ("word", ["a"], [1, None]),
        ("switch", [True], [1, "no", None]),
    ],
)
def test_each_kind_of_field_takes_what_it_says(field, good, bad):
    for value in good:
        assert getattr(Motor(**{field: value}), field) == value
    for value in bad:
        with pytest.raises(InputError, match=f"Motor.{field}"):
            Motor(**{field: value})


def test_fields_are_given_by_name_but_for_those_declared_otherwise():
    assert Wheel(Motor(), radius=1).radius == 1
    with pytest.raises(InputError, match="by name"):
        Wheel(Motor(), 1)
    with pytest.raises(InputError, match="by name"):
        Motor(1.0)


def test_a_description_cannot_be_changed():
    motor = Motor()
    with pytest.raises(dataclasses.FrozenInstanceError):
        motor.power = 2.0  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError):
        motor.new = 2.0  # type: ignore[attr-defined]


def test_replace_checks_anew():
    motor = Motor(power=3)
    assert motor.replace(share=0.1) == Motor(power=3, share=0.1)
    assert motor.power == 3
    with pytest.raises(InputError):
        motor.replace(power=NAN)
    with pytest.raises(InputError, match="no field"):
        motor.replace(pwr=1)


def test_equal_descriptions_are_equal_and_have_equal_hashes():
    assert Motor(power=2) == Motor(power=2.0)
    assert hash(Motor(power=2)) == hash(Motor(power=2.0))
    assert Motor(power=2) != Motor(power=3)


def test_its_text_shows_what_differs_from_the_defaults_and_can_be_evaluated():
    assert repr(Motor()) == "Motor()"
    motor = Motor(power=2, kind="geared")
    assert repr(motor) == "Motor(power=2.0, kind='geared')"
    assert eval(repr(motor), {"Motor": Motor}) == motor


def test_a_subclass_adds_fields_and_keeps_the_gate():
    class Stepper(Motor):
        steps: int = 200

    assert Stepper(steps=100, power=2).power == 2
    with pytest.raises(InputError, match=r"Stepper.power"):
        Stepper(power=NAN)
    with pytest.raises(InputError, match="did you mean 'steps'"):
        Stepper(step=1)


def test_an_inherited_field_keeps_its_check_when_a_subclass_declares_it_anew():
    class Wrong(Motor):
        power: float = -1.0

    class WrongToo(Motor):
        share = 2

    class Open(Motor):
        power: float

    with pytest.raises(InputError, match=r"Wrong.power = -1.0: expected a number > 0"):
        Wrong()
    with pytest.raises(InputError, match=r"WrongToo.share = 2"):
        WrongToo()
    with pytest.raises(InputError, match=r"Open.power is missing"):
        Open()
    with pytest.raises(InputError, match=r"Open.power = nan"):
        Open(power=NAN)
