"""Commands take effect after the transmission delay, whole sampling times or not."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mars2d.bodies.delay import DelayLine


@given(
    delay=st.floats(0, 5),
    sampling_time=st.floats(0.01, 2),
    count=st.integers(1, 30),
)
def test_what_is_in_effect_was_issued_a_delay_ago(delay, sampling_time, count):
    line = DelayLine(delay, sampling_time, np.zeros((2, 1)))
    for k in range(count):
        pieces = line.send(np.full((2, 1), float(k + 1)))  # command k reads k + 1, before it 0
        assert sum(duration for duration, _ in pieces) == pytest.approx(sampling_time)
        time = k * sampling_time
        for duration, command in pieces:
            assert duration > 0
            middle = time + duration / 2
            issued = np.floor((middle - delay) / sampling_time)
            assert command[0, 0] == max(issued + 1, 0)
            time += duration
