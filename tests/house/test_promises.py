"""The table of promises: each has a figure, a command that there is, and the day it was run."""

from __future__ import annotations

import datetime as dt
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from mars2d.cli.command_line import main
from mars2d.cli.verbs import VERBS

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "promises.md"


class Promise(NamedTuple):
    """A row of the table."""

    promise: str
    figure: str
    command: str
    last_run: str


def promises() -> list[Promise]:
    rows = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line[:1] == "|"]
    cells = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in rows]
    assert cells[0] == ["promise", "figure", "command", "last run"]
    return [Promise(*row) for row in cells[2:]]


def commands(first: str) -> list[list[str]]:
    """The words of all commands that begin so."""
    every = [shlex.split(text) for row in promises() for text in re.findall("`(.+?)`", row.command)]
    return [words for words in every if words[0] == first]


def test_each_promise_has_a_figure_a_command_and_a_day():
    assert len(promises()) > 30
    for row in promises():
        assert all(row), row
        assert re.search("`(pytest|python|mars2d|mypy|ruff) ", row.command), row
        assert dt.date.fromisoformat(row.last_run) >= dt.date(2026, 11, 1)
    assert len({row.promise for row in promises()}) == len(promises())


@pytest.mark.slow
def test_the_tests_named_are_there():
    asked = commands("pytest")
    named = {word for words in asked for word in words[1:] if word.startswith("tests/")}
    found = collected(sorted(named))
    for words in asked:
        places = [word for word in words[1:] if word.startswith("tests/")] or ["tests/"]
        chosen = [node for node in found if any(node.startswith(place) for place in places)]
        if "-k" in words:
            chosen = [node for node in chosen if words[words.index("-k") + 1] in node]
        assert chosen, shlex.join(words)


def collected(places: list[str]) -> list[str]:
    options = ["--collect-only", "-q", "-p", "no:cacheprovider", "-m", ""]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, *places],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-2000:]
    return done.stdout.splitlines()


@pytest.mark.parametrize(
    "words", [pytest.param(words, id=shlex.join(words)) for words in commands("python")]
)
def test_the_programs_named_are_there_and_take_these_options(words):
    path = words[1] if words[1] != "-m" else words[2].replace(".", "/") + "/__main__.py"
    text = (ROOT / path).read_text(encoding="utf-8")
    for option in [word for word in words[2:] if word.startswith("--")]:
        assert f'"{option}"' in text, option


@pytest.mark.parametrize(
    "words", [pytest.param(words, id=shlex.join(words)) for words in commands("mars2d")]
)
def test_the_verbs_named_are_there_and_take_these_options(words, capsys):
    assert words[1] in VERBS
    with pytest.raises(SystemExit):
        main([words[1], "--help"])
    told = capsys.readouterr().out
    for option in [word for word in words[2:] if word.startswith("--")]:
        assert option in told, option
