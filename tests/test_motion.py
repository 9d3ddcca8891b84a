"""Motion that nothing disturbs, in closed form: against integrals, and cut in pieces."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mars2d.floor import GRAVITY, chord_velocity, glide

speeds = st.floats(-10, 10)
rates = st.one_of(st.just(0.0), st.floats(1e-3, 50))
times = st.floats(1e-6, 20)


@given(vx=speeds, vy=speeds, spin=speeds, brake=rates, slow=rates, first=times, second=times)
def test_gliding_for_two_times_is_gliding_for_their_sum(
    vx, vy, spin, brake, slow, first, second
):
    velocity, slowing = np.array([[vx, vy, spin]]), np.array([[brake, slow]])
    moved, end = glide(velocity, slowing, first + second)
    half, between = glide(velocity, slowing, first)
    rest, after = glide(between, slowing, second)
    assert half + rest == pytest.approx(moved, rel=1e-9, abs=1e-9)
    assert after == pytest.approx(end, rel=1e-9, abs=1e-9)


@given(vx=speeds, vy=speeds, spin=speeds, brake=rates, slow=rates, h=times)
def test_gliding_is_the_integral_of_a_speed_that_falls_at_a_constant_rate(
    vx, vy, spin, brake, slow, h
):
    moved, end = glide(np.array([[vx, vy, spin]]), np.array([[brake, slow]]), h)
    speed = np.hypot(vx, vy)
    left = max(speed - brake * h, 0.0)
    lasts = min(h, speed / brake) if brake else h
    way = (speed + left) / 2 * lasts
    assert np.hypot(*moved[0, :2]) == pytest.approx(way, rel=1e-9, abs=1e-12)
    assert np.hypot(*end[0, :2]) == pytest.approx(left, rel=1e-9, abs=1e-9)
    assert moved[0, 0] * vy == pytest.approx(moved[0, 1] * vx, rel=1e-9, abs=1e-9)  # straight
    assert abs(end[0, 2]) == pytest.approx(max(abs(spin) - slow * h, 0.0), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("mu", [0.01, 0.1, 1.0])
def test_what_slides_stops_after_its_square_of_speed_over_twice_its_braking(mu):
    moved, end = glide(np.array([[3.0, 4.0, 0.0]]), np.array([[mu * GRAVITY, 0.0]]), 1e4)
    assert np.hypot(*moved[0, :2]) == pytest.approx(25 / (2 * mu * GRAVITY), rel=1e-12)
    assert end.tolist() == [[0, 0, 0]]


def test_what_rests_stays_at_rest_whatever_the_floor():
    moved, end = glide(np.zeros((2, 3)), np.array([[0.0, 0.0], [5.0, 5.0]]), 3.0)
    assert not moved.any()
    assert not end.any()


@given(forward=speeds, left=speeds, spin=speeds, theta=st.floats(-7, 7), h=st.floats(1e-6, 2))
def test_the_chord_is_the_integral_of_the_arc(forward, left, spin, theta, h):
    chord = chord_velocity(
        np.array([[forward], [left], [spin]]), np.array([theta]), h, np.array([True])
    )
    # Gauss and Legendre's rule with 40 points integrates 20 rad of a sine to the last digits.
    points, weights = np.polynomial.legendre.leggauss(40)
    angle = theta + spin * h * (points + 1) / 2
    x = (weights * (forward * np.cos(angle) - left * np.sin(angle))).sum() / 2
    y = (weights * (forward * np.sin(angle) + left * np.cos(angle))).sum() / 2
    assert chord[0] == pytest.approx([x, y, spin], abs=1e-12 * (1 + abs(forward) + abs(left)))


def test_in_the_worlds_frame_a_chord_is_the_command():
    twist = np.array([[0.3], [-0.2], [2.0]])
    chord = chord_velocity(twist, np.array([1.0]), 5.0, np.array([False]))
    assert chord.tolist() == [[0.3, -0.2, 2.0]]
