"""The page "Try it" in a real browser: choose an example, change a number, run, see the replay."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.processes import served

CHECKOUT = Path(__file__).parents[2]


@pytest.fixture
def address(tmp_path):
    folder = os.environ.get("MARS2D_PYODIDE")
    if not folder:
        pytest.skip("needs a folder of Pyodide in MARS2D_PYODIDE: .ci/pyodide.py")
    make = [sys.executable, CHECKOUT / "docs" / "make" / "try_it.py", tmp_path, "--pyodide", folder]
    subprocess.run(make, check=True)
    with served(tmp_path) as address:
        yield f"{address}index.html"


@pytest.mark.nightly
def test_an_example_is_chosen_changed_and_run(browser, address):
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.set_default_timeout(60_000)
    page.goto(f"{address}?example=follow_the_leader")
    state, code = page.locator("#state"), page.locator("#code")
    state.get_by_text("Ready").wait_for()
    assert "followers" in code.input_value()
    page.locator("#sliders input").first.fill("2")
    page.get_by_role("button", name="Run").click()
    page.locator("#state", has_text="Done").wait_for()
    replay = page.frame_locator("#replay")
    replay.locator("#time", has_text="s").wait_for()
    assert replay.locator("#bodies option").count() == 1 + 3  # a leader and two
    shots = os.environ.get("MARS2D_SHOTS")
    if shots:
        page.screenshot(path=f"{shots}/wide.png")
        page.set_viewport_size({"width": 390, "height": 844})
        page.screenshot(path=f"{shots}/narrow.png", full_page=True)
    code.fill(code.input_value() + "\nx = 1 / 0\n")
    code.blur()
    page.locator("#state.wrong", has_text="ZeroDivisionError").wait_for()
    assert "line" in state.inner_text()
    page.close()
