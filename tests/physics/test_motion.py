"""The chords of arcs, against integrals."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mars2d.physics.motion import Arcs

speeds = st.floats(-10, 10)


@given(forward=speeds, left=speeds, spin=speeds, theta=st.floats(-7, 7), h=st.floats(1e-6, 2))
def test_the_chord_is_the_integral_of_the_arc(forward, left, spin, theta, h):
    arcs = Arcs(np.array([[forward], [left], [spin]]), np.array([True]))
    chord = arcs.chord(np.array([theta]), h)
    # Gauss and Legendre's rule with 40 points integrates 20 rad of a sine to the last digits.
    points, weights = np.polynomial.legendre.leggauss(40)
    angle = theta + spin * h * (points + 1) / 2
    x = (weights * (forward * np.cos(angle) - left * np.sin(angle))).sum() / 2
    y = (weights * (forward * np.sin(angle) + left * np.cos(angle))).sum() / 2
    assert chord[0] == pytest.approx([x, y, spin], abs=1e-12 * (1 + abs(forward) + abs(left)))


def test_in_the_worlds_frame_a_chord_is_the_command():
    twist = np.array([[0.3], [-0.2], [2.0]])
    chord = Arcs(twist, np.array([False])).chord(np.array([1.0]), 5.0)
    assert chord.tolist() == [[0.3, -0.2, 2.0]]
