"""A real browser for the tests of pages: Chromium without a head, which sees, clicks and types."""

from __future__ import annotations

import base64
import io
import os
import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.processes import PATIENCE

CHROMIUM = os.environ.get("MARS2D_CHROMIUM") or shutil.which("chromium")


@contextmanager
def running_browser() -> Iterator[Any]:
    """Start Chromium; skip the test where it or playwright is missing."""
    api = pytest.importorskip("playwright.sync_api", reason="needs playwright")
    if CHROMIUM is None:
        pytest.skip("needs Chromium: apt-get install chromium")
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM)
        yield browser
        browser.close()


class Tab:
    """A page in a browser without a network, and all that it asked for and complained about."""

    def __init__(self, browser: Any, size: tuple[int, int], script: str = "", **how: Any) -> None:
        """Open an empty one; how: what the context is like, as color_scheme="dark".

        script: runs before those of the page.
        """
        how = {"reduced_motion": "reduce", "color_scheme": "light", **how}
        self.context = browser.new_context(
            viewport={"width": size[0], "height": size[1]}, offline=True, **how
        )
        self.context.set_default_timeout(PATIENCE * 1000)
        self.page = self.context.new_page()
        self.page.add_init_script(script)
        self.asked: list[str] = []
        self.complaints: list[str] = []
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))

    def open(self, path: Path) -> None:
        """Open a replay, and wait until it is drawn."""
        self.page.goto(path.as_uri())
        self.page.locator("#time", has_text="s").wait_for()
        self.settle()

    def close(self) -> None:
        """Close it."""
        self.context.close()

    # -- what one does ------------------------------------------------------------------------

    def click(self, name: str) -> None:
        """Click a button by what a screen reader calls it."""
        self.page.get_by_role("button", name=name, exact=True).click()
        self.settle()

    def press(self, *keys: str) -> None:
        """Press keys, one after the other."""
        for key in keys:
            self.page.keyboard.press(key)
        self.settle()

    def go(self, row: int) -> None:
        """Pull the time to a row."""
        self.page.locator("#slider").fill(str(row))
        self.settle()

    def settle(self) -> None:
        """Wait until what was done is drawn."""
        self.page.evaluate(
            "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
        )

    def pinch(self, center: tuple[float, float], before: float, after: float) -> None:
        """Put two fingers on the page and move them apart, pixels."""
        x, y = center
        touch = self.context.new_cdp_session(self.page)

        def send(kind: str, apart: float) -> None:
            points = [{"x": x + s * apart / 2, "y": y, "id": k} for k, s in enumerate((-1, 1))]
            points = points if kind != "touchEnd" else []
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        send("touchStart", before)
        for apart in np.linspace(before, after, 6).tolist():
            send("touchMove", apart)
        send("touchEnd", after)
        self.settle()

    def until(self, done: Callable[[], bool], seconds: float = PATIENCE) -> None:
        """Wait until something is so."""
        end = time.monotonic() + seconds
        while not done():
            assert time.monotonic() < end, "it took too long"
            self.page.wait_for_timeout(20)

    # -- what one sees ------------------------------------------------------------------------

    def text(self, selector: str) -> str:
        """Return the words of an element."""
        return str(self.page.locator(selector).inner_text())

    def row(self) -> int:
        """Return the row that the slider stands on."""
        return int(self.page.locator("#slider").input_value())

    def is_on(self, selector: str) -> bool:
        """Return whether a switch is on."""
        return bool(self.page.locator(selector).get_attribute("aria-pressed") == "true")

    def picture(self) -> np.ndarray[Any, np.dtype[np.uint8]]:
        """Return the pixels of the picture, (rows, columns, 3)."""
        from PIL import Image

        url = self.page.evaluate("document.getElementById('picture').toDataURL('image/png')")
        with Image.open(io.BytesIO(base64.b64decode(url.partition(",")[2]))) as image:
            return np.asarray(image.convert("RGB"))

    def middle_of(self, color: str) -> tuple[float, float]:
        """Return the middle of all that has a colour, pixels of the page."""
        wanted = [int(color[k : k + 2], 16) for k in (1, 3, 5)]
        y, x = np.nonzero((self.picture() == wanted).all(axis=2))
        assert len(x), f"nothing has the colour {color}"
        box = self.page.locator("#picture").bounding_box()
        share = box["width"] / self.picture().shape[1]
        return box["x"] + share * float(x.mean()), box["y"] + share * float(y.mean())


def differing(one: Any, other: Any) -> float:
    """Return the share of the pixels of two pictures that are clearly not the same."""
    if one.shape != other.shape:
        return 1.0
    apart = np.abs(one.astype(int) - other.astype(int)).max(axis=2)
    return float((apart > 48).mean())
