"""Ctrl-C: raised once, late while something is saved, and not lost."""

import signal

import pytest

from mars2d.core.interrupt import interrupts


def press(times=1):
    for _ in range(times):
        signal.raise_signal(signal.SIGINT)


def test_a_block_raises_it_once_and_remembers_it():
    with interrupts() as check:
        check()
        with pytest.raises(KeyboardInterrupt):
            press()
        press(3)  # while the program tidies up after it
        with pytest.raises(KeyboardInterrupt):
            check()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_block_that_holds_it_back_raises_it_at_its_end(capfd):
    done = []
    with pytest.raises(KeyboardInterrupt), interrupts(held="saving run.npz"):
        press(2)
        done.append("saved")
    assert done == ["saved"]
    assert capfd.readouterr().err == "mars2d: one moment: saving run.npz\n"


def test_the_innermost_block_counts():
    with interrupts(held=""), pytest.raises(KeyboardInterrupt), interrupts():
        press()
    with pytest.raises(KeyboardInterrupt), interrupts(), interrupts(held=""):
        press()


def test_a_handler_of_other_code_stays():
    seen = []
    before = signal.signal(signal.SIGINT, lambda *_: seen.append("theirs"))
    try:
        with interrupts() as check:
            press()
            check()
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == ["theirs"]
