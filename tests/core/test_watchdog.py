"""The watchdog: what does not return is broken off, what only takes long is not."""

import signal
import sys
import threading
import time

import pytest

from mars2d.core import watchdog
from mars2d.core.errors import InputError, LawError
from mars2d.core.usercode import Hangs, called
from mars2d.core.watchdog import VARIABLE, Watchdog, patience
from tests.processes import wait_until


@pytest.fixture
def soon(monkeypatch):
    """A patience of a fraction of a second, and many looks in it."""
    monkeypatch.setattr(watchdog, "LOOK", 0.01)
    monkeypatch.setenv(VARIABLE, "0.2")


def spin():
    while True:
        pass


def nap():
    while True:
        time.sleep(0.01)


def swallow():
    while True:
        try:
            spin()
        except Exception:
            continue


@pytest.mark.parametrize("law", [spin, nap, swallow])
def test_what_never_returns_is_an_error_of_its_line(soon, law):
    with (
        pytest.raises(
            LawError, match=r"^test_watchdog.py, line \d+: go did not return within 0.2 s"
        ),
        Watchdog(lambda: 0),
        called("go", law),
    ):
        law()


def test_it_tells_the_robot(soon):
    with (
        pytest.raises(LawError, match=r"\(red\)$") as raised,
        Watchdog(lambda: 0),
        called("go", spin, "red"),
    ):
        spin()
    assert raised.value.robot == "red"


def test_calls_that_follow_each_other_may_take_long_together(soon):
    calls = 0
    with Watchdog(lambda: calls):
        for calls in range(40):  # noqa: B007
            for _ in range(2000):
                sum(range(100))


def test_only_code_that_the_block_calls_is_broken_off(soon):
    end = time.thread_time() + 0.6
    with Watchdog(lambda: 0):
        while time.thread_time() < end:
            pass


def test_in_a_debugger_nothing_is_broken_off(soon):
    def look(frame, event, argument):
        return look

    before = sys.gettrace()
    sys.settrace(look)
    try:
        with Watchdog(lambda: 0):
            _busy(0.6)
    finally:
        sys.settrace(before)


def _busy(seconds):
    """Take the processor's time."""
    end = time.thread_time() + seconds
    while time.thread_time() < end:
        pass


def test_zero_waits_for_ever(soon, monkeypatch):
    monkeypatch.setenv(VARIABLE, "0")
    assert patience() == float("inf")
    with Watchdog(lambda: 0):
        _busy(0.6)


@pytest.mark.parametrize("text", ["soon", "-1", "nan"])
def test_a_patience_that_is_none_is_refused(monkeypatch, text):
    monkeypatch.setenv(VARIABLE, text)
    with pytest.raises(InputError, match=f"MARS2D_PATIENCE='{text}': expected seconds, 0 or more"):
        Watchdog(lambda: 0)


def test_whoever_is_asked_meanwhile_may_end_it(soon, monkeypatch):
    monkeypatch.setenv(VARIABLE, "1000")
    asked = []

    def meanwhile(where):
        asked.append(where)
        return "was not wanted any more" if len(asked) > 2 else ""

    with (
        pytest.raises(LawError, match="go was not wanted any more"),
        Watchdog(lambda: 0, meanwhile),
        called("go", spin),
    ):
        spin()
    assert all(where.startswith("test_watchdog.py, line ") for where in asked)


def test_it_watches_its_own_thread_only(soon):
    ended = threading.Event()
    seen = []

    def other():
        try:
            with Watchdog(lambda: 0):
                spin()
        except Hangs as error:
            seen.append(error.why)
        ended.set()

    threading.Thread(target=other, daemon=True).start()
    wait_until(ended.is_set)
    assert seen == ["did not return within 0.2 s"]


def test_its_thread_ends_with_the_block(soon):
    with Watchdog(lambda: 0):
        assert any(each.name == "mars2d watchdog" for each in threading.enumerate())
    wait_until(lambda: not any(t.name == "mars2d watchdog" for t in threading.enumerate()))


def test_ctrl_c_while_somebody_is_asked_is_not_lost(soon, monkeypatch):
    monkeypatch.setenv(VARIABLE, "0")

    def meanwhile(where):
        signal.raise_signal(signal.SIGINT)
        return ""

    with pytest.raises(KeyboardInterrupt), Watchdog(lambda: 0, meanwhile):
        spin()
