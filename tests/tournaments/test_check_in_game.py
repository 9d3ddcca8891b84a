"""``mars2d check LAW --for GAME --role ROLE``: a law is tried in the very game."""

import pytest

from mars2d.cli.command_line import BAD_INPUT, main
from tests.cases import each_case

GAME = ["--for", "corner_game", "--role", "pursuer", "--set", "stop_time=3.0"]


@pytest.fixture
def check(tmp_path, monkeypatch, capsys):
    """Return a function that checks a law's text, and returns code, output and error."""
    monkeypatch.chdir(tmp_path)

    def tried(text, name="law.py", arguments=GAME):
        (tmp_path / name).write_text(text)
        code = main(["check", name, *arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return tried


def test_a_law_that_plays_is_sound_and_its_matches_are_told(check):
    code, out, _ = check("def control(robot):\n    return 1.0, 0.0\n")
    assert code == 0
    *matches, last = out.splitlines()
    assert matches == [
        f"law, seed {seed}: blue was not caught in 3 s: evader wins" for seed in (0, 1, 2)
    ]
    assert last == "sound: won 0 of 3 matches as pursuer of corner_game, and forfeited none"


@each_case(
    "text, words",
    [
        ("def control(robot):\n    return robot.pse\n", "law.py, line 2: a robot has no 'pse'"),
        ("def control(robot):\n    return 1\n", "law"),
        ("def contrl(robot):\n    return 0, 0\n", "law.py: has no law 'control'; did you mean"),
        ("import nothing_of_this_name\n", "law.py, line 1"),
        ("def control(robot):\n    robot.world.pose\n    return 0, 0\n", "law.py, line 2"),
    ],
)
def test_a_law_that_would_forfeit_is_refused_with_its_line(check, text, words):
    code, _, error = check(text)
    assert code == BAD_INPUT
    assert words in error
    assert error.count("\n") == 1
    assert "as pursuer of corner_game it would forfeit its matches" in error


def test_what_a_law_prints_is_shown(check):
    _, out, _ = check("def control(robot):\n    print('here')\n    return 0, 0\n")
    assert "law printed:\nhere" in out
