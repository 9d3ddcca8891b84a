"""The chords of arcs, against integrals."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.islands import DISC, body_of, piece_of

speeds = st.floats(-10, 10)


def chord_of(forward, left, spin, theta, h, *, in_robot_frame: bool) -> list[float]:
    """The velocity at which a robot is aimed for h s: x', y', theta'."""
    body = body_of(piece_of(DISC, 0.15))
    body.in_robot_frame = in_robot_frame
    body.forward, body.left, body.turning = forward, left, spin
    body.follow(theta, h)
    return [body.aim_x, body.aim_y, body.aim_spin]


@given(forward=speeds, left=speeds, spin=speeds, theta=st.floats(-7, 7), h=st.floats(1e-6, 2))
def test_the_chord_is_the_integral_of_the_arc(forward, left, spin, theta, h):
    chord = chord_of(forward, left, spin, theta, h, in_robot_frame=True)
    # Gauss and Legendre's rule with 40 points integrates 20 rad of a sine to the last digits.
    points, weights = np.polynomial.legendre.leggauss(40)
    angle = theta + spin * h * (points + 1) / 2
    x = (weights * (forward * np.cos(angle) - left * np.sin(angle))).sum() / 2
    y = (weights * (forward * np.sin(angle) + left * np.cos(angle))).sum() / 2
    assert chord == pytest.approx([x, y, spin], abs=1e-12 * (1 + abs(forward) + abs(left)))


def test_in_the_worlds_frame_a_chord_is_the_command():
    assert chord_of(0.3, -0.2, 2.0, 1.0, 5.0, in_robot_frame=False) == [0.3, -0.2, 2.0]
