"""Laws that misbehave in commands: an error with its line, and everybody else goes on."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest

import mars2d
from tests.processes import mars

pytestmark = pytest.mark.slow

WHIMS = '''\
"""A law that raises what is no Exception, or returns what raises."""

import asyncio

from mars2d import Robot, Scenario


class Whim(BaseException):
    def __str__(self):
        raise Whim


class Odd:
    def __init__(self, error):
        self.error = error

    def _raise(self, *_, **__):
        raise self.error

    __array__ = __float__ = __iter__ = __str__ = __repr__ = _raise


KINDS = {"whim": Whim, "cancelled": asyncio.CancelledError, "exit": GeneratorExit}


def scenario(kind="whim", value=False):
    def go(robot):
        if robot.time > 0.25:
            if value:
                return Odd(KINDS[kind]())
            raise KINDS[kind]()
        return 0.2, 0

    return Scenario(robots=[Robot(name="red", controller=go)], stop_time=1)
'''


@pytest.fixture
def whims(tmp_path):
    (tmp_path / "whims.py").write_text(WHIMS)
    return tmp_path


def test_a_run_says_the_line_and_keeps_its_record(whims):
    done = mars("run", "whims.py", "--headless", "--record", "kept.npz", cwd=whims)
    assert done.returncode == 2
    assert "whims.py, line 31: go raised Whim, whose text raises Whim (red, at" in done.stderr
    assert "Traceback" not in done.stderr
    assert len(mars2d.load(whims / "kept.npz")) == 3


def test_a_sweep_has_them_in_its_rows(whims):
    grid = ["--set", "kind=cancelled,exit", "--set", "value=False,True"]
    mars("sweep", "whims.py", *grid, "--workers", "2", "--out", "s.csv", cwd=whims)
    rows = (whims / "s.csv").read_text().splitlines()[1:]
    assert len(rows) == 4
    for row in rows:
        assert "whims.py, line 18: go raised " in row or "whims.py, line 31: go raised " in row


def test_so_does_one_in_threads(whims):
    with ThreadPoolExecutor(2) as executor, pytest.raises(mars2d.Mars2dError) as caught:
        mars2d.sweep(whims / "whims.py", {"kind": ["exit", "cancelled"]}, executor=executor)
    assert "whims.py, line 31: go raised" in str(caught.value)
