"""The time limit: what does not return is broken off, what only takes long is not."""

import threading
import time

import pytest

from mars2d.core import deadline
from mars2d.core.deadline import VARIABLE, Deadline, patience
from mars2d.core.errors import InputError, Late, LawError
from mars2d.core.usercode import called
from tests.processes import PATIENCE, wait_until


@pytest.fixture
def soon(monkeypatch):
    """Many looks in a fraction of a second."""
    monkeypatch.setattr(deadline, "LOOK", 0.01)
    monkeypatch.setattr(deadline, "GRACE", 0.1)


def of_calls(calls=lambda: 0, seconds=0.2, meanwhile=None):
    return Deadline(seconds, calls=calls, meanwhile=meanwhile)


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


def test_what_never_returns_is_an_error_of_its_line_and_robot(soon):
    for law in (spin, nap, swallow):
        with pytest.raises(LawError) as raised, of_calls(), called("go", law, "red"):
            law()
        said = str(raised.value)
        assert said.startswith("test_deadline.py, line "), law
        assert said.endswith(": go did not return within 0.2 s (red)"), law


def test_the_limit_of_a_block_is_told_to_the_block_with_the_line(soon):
    limit = Deadline(0.2)
    for _ in range(2):  # it can be used again
        with pytest.raises(Late), limit, called("go", spin):
            spin()
        assert limit.arrived().startswith("test_deadline.py, line ")


def test_what_catches_everything_is_given_up_with_its_line(soon):
    ended, told = threading.Event(), []

    def give_up(where):
        told.append(where)
        ended.set()

    def swallow_all():
        while not ended.is_set():
            try:
                ended.wait(0.01)
            except BaseException:
                continue

    with Deadline(0.05, give_up):
        swallow_all()
    assert told[0].startswith("test_deadline.py, line ")


def test_the_variable_sets_the_patience_and_zero_waits_for_ever(monkeypatch):
    monkeypatch.setenv(VARIABLE, "0")
    assert patience() == float("inf")
    for text in ("soon", "-1", "nan"):
        monkeypatch.setenv(VARIABLE, text)
        with pytest.raises(InputError, match=f"MARS2D_PATIENCE='{text}': expected seconds, 0 or"):
            patience()


def test_whoever_is_asked_meanwhile_may_end_it(soon):
    asked = []

    def meanwhile(where):
        asked.append(where)
        return "was not wanted any more" if len(asked) > 2 else ""

    with (
        pytest.raises(LawError, match="go was not wanted any more"),
        of_calls(seconds=1000.0, meanwhile=meanwhile),
        called("go", spin),
    ):
        spin()
    assert all(where.startswith("test_deadline.py, line ") for where in asked)


def test_code_that_waits_in_c_is_asked_about_all_the_same_and_given_up_at_once(soon):
    seen, woken = [], threading.Event()

    def meanwhile(where):
        seen.append((limit.blocked, where.partition(",")[0]))
        return "was not wanted any more"

    def wait():
        woken.wait(PATIENCE)  # a call in C: no step of Python is done
        spin()

    limit = Deadline(1000.0, lambda where: woken.set(), lambda: 0, meanwhile)
    with pytest.raises(LawError), limit, called("go", wait):
        wait()
    assert woken.is_set()
    assert seen[0] == (True, "test_deadline.py")


def test_it_watches_its_own_thread_only_and_ends_with_the_block(soon):
    seen = []

    def other():
        try:
            with of_calls():
                spin()
        except Late as error:
            seen.append(error.why)

    threading.Thread(target=other, daemon=True).start()
    wait_until(lambda: seen)
    assert seen == ["did not return within 0.2 s"]
    wait_until(lambda: not any(t.name == "mars2d deadline" for t in threading.enumerate()))
