"""The help is one screen, and asking for it imports next to nothing."""

import pytest

from mars2d.cli import command_line as cli
from tests.cases import each_case

SLOW = {"numpy", "pygame", "matplotlib", "importlib.metadata", "pymunk"}

IMPORTED = """
import sys
from mars2d.cli.command_line import main
try:
    main({words})
except SystemExit:
    print(*(each for each in sys.modules if each in {wanted}), file=sys.stderr)
"""

VERBS = {f"mars2d.cli.verbs.{name}" for name in cli.VERBS}


def imported(child, words, wanted):
    done = child(IMPORTED.format(words=words, wanted=wanted))
    assert done.returncode == 0, done.stderr
    return set(done.stderr.split())


def test_the_help_is_one_screen_that_names_each_verb_and_says_what_it_is_for(capsys):
    with pytest.raises(SystemExit):
        cli.main(["--help"])
    lines = capsys.readouterr().out.splitlines()
    assert 24 <= len(lines) <= 40
    assert max(map(len, lines)) <= 80
    for name, line in cli.VERBS.items():
        assert f"  {name:<12}{line}" in lines


@each_case("words", [["--help"], ["--version"]])
def test_the_help_imports_no_verb_and_no_large_library(child, words):
    assert imported(child, words, SLOW | VERBS) == set()


def test_the_help_of_a_verb_imports_that_verb_alone(child):
    assert imported(child, ["plot", "--help"], VERBS) == {"mars2d.cli.verbs.plot"}
