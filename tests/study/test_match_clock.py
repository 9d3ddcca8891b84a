"""The clock of a match: it runs while the match looks, and not while it is kept from looking."""

import pytest

from mars2d.study.isolation import clock
from mars2d.study.isolation.clock import LATE, Clock


@pytest.fixture
def now(monkeypatch):
    """The computer's time, which goes only where the test says so."""
    time = [100.0]
    monkeypatch.setattr(clock.time, "perf_counter", lambda: time[0])
    return time


def test_it_counts_from_look_to_look(now):
    match = Clock()
    for k in range(1, 50):
        now[0] = 100.0 + 0.1 * k
        assert match.now() == pytest.approx(0.1 * k)


def test_a_pause_counts_as_one_late_look(now):
    match = Clock()
    now[0] += 0.1
    assert match.now() == pytest.approx(0.1)
    now[0] += 65.0
    assert match.now() == pytest.approx(0.1 + LATE)
    now[0] += 0.1
    assert match.now() == pytest.approx(0.2 + LATE)


def test_two_matches_have_two_clocks(now):
    one = Clock()
    now[0] += 0.2
    other = Clock()
    now[0] += 0.1
    assert (one.now(), other.now()) == (pytest.approx(0.3), pytest.approx(0.1))
