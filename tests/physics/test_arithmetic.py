"""Sines and powers that round the same everywhere: against those of the C library."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mars2d.physics.islands.arithmetic import chord_share, cosine_sine, exponential, power, sine

ULP = 2.0**-53
"""Half the distance between 1 and the next number: by this much a rounded sine may be off."""


def cosine(angle: float) -> float:
    return cosine_sine(angle)[0]


BOTH = [(sine, math.sin), (cosine, math.cos)]
angles = st.floats(-1e6, 1e6)


def off(found: float, expected: float) -> float:
    """How many units in the last place two numbers differ by."""
    return abs(found - expected) / math.ulp(expected)


@given(angle=st.one_of(angles, st.floats(-10, 10)))
@pytest.mark.parametrize(("ours", "theirs"), BOTH, ids=["sine", "cosine"])
def test_sines_and_cosines_are_the_librarys_to_their_last_digit(ours, theirs, angle):
    assert abs(ours(angle) - theirs(angle)) <= 2 * ULP
    if abs(theirs(angle)) > 1e-3:
        assert off(ours(angle), theirs(angle)) <= 2


@given(angle=st.floats(1e6, 1e12))
@pytest.mark.parametrize(("ours", "theirs"), BOTH, ids=["sine", "cosine"])
def test_angles_of_more_turns_than_anything_makes_lose_as_little_as_two_pi_is_rounded(
    ours, theirs, angle
):
    rounded = 2.5e-16 * angle / (2 * math.pi)
    assert ours(angle) == pytest.approx(theirs(angle), abs=rounded + 2 * ULP)
    assert ours(-angle) == pytest.approx(theirs(-angle), abs=rounded + 2 * ULP)


@given(angle=angles)
def test_sine_and_cosine_are_symmetric_to_the_bit(angle):
    assert sine(-angle) == -sine(angle)
    assert cosine(-angle) == cosine(angle)


@given(half=st.floats(1e-300, 50))
def test_the_share_of_a_chord_is_sine_over_angle(half):
    assert chord_share(half) == pytest.approx(math.sin(half) / half, rel=1e-15, abs=2 * ULP)
    assert chord_share(-half) == chord_share(half)


@given(x=st.floats(0, 1), exponent=st.floats(0, 300))
def test_powers_are_the_librarys_but_for_rounding_their_logarithms(x, exponent):
    expected = math.pow(x, exponent)
    if expected < 1e-300:
        assert 0 <= power(x, exponent) < 2e-300
    else:
        rounding = 2 * math.ulp(1.0) * (1 + abs(math.log(expected)))
        assert power(x, exponent) == pytest.approx(expected, rel=rounding, abs=0)


@given(y=st.one_of(st.floats(-700, 0), st.floats(-1, 0)))
def test_exponentials_are_the_librarys_to_their_last_digit(y):
    assert off(exponential(y), math.exp(y)) <= 2


def test_the_ends_of_powers():
    assert power(0.0, 0.0) == 1.0
    assert power(0.0, 0.5) == 0.0
    assert power(1.0, 123.4) == 1.0
    assert power(0.5, 1.0) == pytest.approx(0.5, rel=1e-15)
    assert power(5e-324, 1.0) == 0.0  # so little that it counts as nothing
    assert power(1e-300, 0.0) == 1.0
