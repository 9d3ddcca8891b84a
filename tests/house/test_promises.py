"""The table of promises: each has a figure, and a command that there is."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from mars2d.cli.command_line import main
from mars2d.cli.verbs import VERBS
from tests.cases import each_case

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "promises.md"


class Promise(NamedTuple):
    """A row of the table."""

    promise: str
    figure: str
    command: str


def promises() -> list[Promise]:
    text = PAGE.read_text(encoding="utf-8").partition("\n## ")[0]
    rows = [line for line in text.splitlines() if line[:1] == "|"]
    cells = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in rows]
    assert cells[0] == ["promise", "figure", "command"]
    return [Promise(*row) for row in cells[2:]]


def commands(first: str) -> list[list[str]]:
    """The words of all commands that begin so."""
    every = [shlex.split(text) for row in promises() for text in re.findall("`(.+?)`", row.command)]
    return [words for words in every if words[0] == first]


def test_each_promise_has_a_figure_and_a_command():
    assert len(promises()) > 30
    for row in promises():
        assert all(row), row
        assert re.search("`(pytest|python|mars2d|mypy|ruff) ", row.command), row
    assert len({row.promise for row in promises()}) == len(promises())


@pytest.mark.slow
def test_the_tests_named_are_there_and_slow_ones_are_not_left_out():
    asked = commands("pytest")
    found = collected(sorted({word for words in asked for word in words if word[:6] == "tests/"}))
    for words in asked:
        places = tuple(word for word in words if word[:6] == "tests/") or ("tests/",)
        part = words[words.index("-k") + 1] if "-k" in words else ""
        chosen = [
            marks for node, marks in found.items() if node.startswith(places) and part in node
        ]
        wanted = words[words.index("-m") + 1] if "-m" in words else "not slow and not soak"
        told = [{"slow": "slow" in marks, "soak": "soak" in marks} for marks in chosen]
        assert any(eval(wanted, marks) for marks in told), shlex.join(words)
        if "-m" not in words:
            assert not any(marks["slow"] for marks in told), f"slow: {shlex.join(words)}"


LISTING = """
import sys, pytest
class Lister:
    def pytest_collection_finish(self, session):
        for item in session.items:
            print("listed", *(mark.name for mark in item.iter_markers()), item.nodeid, sep="\\t")
sys.exit(pytest.main(sys.argv[1:], plugins=[Lister()]))
"""


def collected(places: list[str]) -> dict[str, set[str]]:
    """Return the names of tests, and their marks."""
    options = ["--collect-only", "-q", "-p", "no:cacheprovider", "-m", ""]
    done = subprocess.run(
        [sys.executable, "-c", LISTING, *options, *places],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-2000:]
    rows = [line.split("\t") for line in done.stdout.splitlines() if line.startswith("listed\t")]
    return {node: {*marks} for _, *marks, node in rows}


@each_case("words", list(commands("python")))
def test_the_programs_named_are_there_and_take_these_options(words):
    path = words[1] if words[1] != "-m" else words[2].replace(".", "/") + "/__main__.py"
    text = (ROOT / path).read_text(encoding="utf-8")
    for option in [word for word in words[2:] if word.startswith("--")]:
        assert f'"{option}"' in text, option


@each_case("words", list(commands("mars2d")))
def test_the_verbs_named_are_there_and_take_these_options(words, capsys):
    assert words[1] in VERBS
    with pytest.raises(SystemExit):
        main([words[1], "--help"])
    told = capsys.readouterr().out
    for option in [word for word in words[2:] if word.startswith("--")]:
        assert option in told, option
