"""What the project costs whoever reads it and runs its tests: numbers that only go down."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CODE = {".py", ".pyx", ".pxd", ".pxi", ".js", ".css", ".html"}

LINES = {
    "addons": 4_196,
    "bodies": 1_997,
    "cli": 2_575,
    "core": 3_149,
    "geometry": 1_560,
    "output": 13_179,
    "physics": 8_250,
    "record": 1_841,
    "reports": 1_006,
    "rl": 887,
    "scenario": 5_515,
    "sensors": 2_031,
    "study": 3_161,
    "testing": 1_016,
    "tournaments": 3_406,
    "window": 15_646,
    "world": 3_972,
    "tests": 54_775,
}
"""Lines at most, by room of the package, and of all tests."""

ITEMS = 2_200
"""Tests at most that `pytest` runs without further words."""


def count(folder: Path) -> int:
    """Count the lines of code below a folder, with docstrings, comments and blank ones."""
    files = [path for path in folder.rglob("*") if path.suffix in CODE]
    return sum(path.read_bytes().count(b"\n") for path in files)


def test_no_room_grows() -> None:
    rooms = [path for path in (ROOT / "mars2d").iterdir() if (path / "__init__.py").exists()]
    found = {path.name: count(path) for path in [*rooms, ROOT / "tests"]}
    over = {name: (n, LINES.get(name)) for name, n in found.items() if n > LINES.get(name, 0)}
    assert not over, f"more lines than allowed: {over}. Remove as many as you add."


def test_the_quick_suite_is_no_larger(request: pytest.FixtureRequest) -> None:
    items = request.session.items
    rooms = Counter(item.path.relative_to(ROOT / "tests").parts[0] for item in items)
    if len(rooms) < 15 or any(item.get_closest_marker("slow") for item in items):
        pytest.skip("not the whole quick suite was collected")
    assert len(items) <= ITEMS, f"more items than allowed, go through cases in one test: {rooms}"
