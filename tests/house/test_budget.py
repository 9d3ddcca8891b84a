"""What the project costs whoever reads it and runs its tests: numbers that only go down."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CODE = {".py", ".pyx", ".pxd", ".pxi", ".js", ".css", ".html"}

LINES = {
    "addons": 3_989,
    "bodies": 1_910,
    "cli": 2_170,
    "core": 3_084,
    "geometry": 1_524,
    "output": 10_336,
    "physics": 7_617,
    "record": 1_618,
    "reports": 631,
    "rl": 851,
    "scenario": 4_825,
    "sensors": 1_834,
    "study": 2_714,
    "testing": 786,
    "tournaments": 3_008,
    "window": 12_022,
    "world": 3_413,
    "tests": 44_493,
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
