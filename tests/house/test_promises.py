"""The page of promises: one screen, and each command names tests and programs that there are."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "promises.md").read_text(encoding="utf-8")


def test_the_page_is_one_screen():
    assert len(PAGE.splitlines()) <= 40


def test_each_promise_has_a_figure_and_a_command_that_there_is():
    rows = re.findall(r"^\| (.+?) \| (.+?) \| `((?:pytest|python) .+)` \|$", PAGE, flags=re.M)
    assert len(rows) == PAGE.count("\n|") - 2
    for _, _, command in rows:
        words = shlex.split(command)
        paths = [word for word in words if "/" in word]
        assert paths, command
        assert all((ROOT / path).exists() for path in paths), command
        if words[0] == "python":
            program = (ROOT / paths[0]).read_text(encoding="utf-8")
            options = [word for word in words if word.startswith("--")]
            assert all(f'"{option}"' in program for option in options), command
