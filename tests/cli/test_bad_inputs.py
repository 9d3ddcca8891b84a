"""Bad inputs as users make them: each is a named error of few lines, with exit code 2.

Those that newcomers make in laws and scenarios are tried by `tests/house/test_mistakes.py`, files
of records, maps and studies where they are read.
"""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest

from mars2d.cli.command_line import main
from tests.cases import each_case

RUN = "run random_walk --headless --stop-time 2"

COMMANDS = [
    ("random_wal", "did you mean 'run random_walk'?"),
    ("replay run.npz --seed 3", "--seed 3 (see mars2d replay"),
    ("doctor --completion nushell", "nushell", "powershell"),
    ("--verbose", "--verbose", "mars2d --help"),
    ("run", "EXPERIMENT", "mars2d run --help"),
    ("run random_walk crowd --headless", "crowd", "mars2d run --help"),
    (f"run {'a' * 300}.py --headless", "aaa", "too long"),
    (f"replay {'a' * 300}.npz", "aaa", "too long"),
    (f"{RUN} --record {'a' * 300}.npz", "aaa", "too long"),
    (f"{RUN} --record a.npz", "a.npz", "folder"),
    (f"{RUN} --record no/where/a.npz", "--record", "no folder"),
    (f"{RUN} --html a.npz", "a.npz", ".html"),
    (f"{RUN} --seed 1.5", "--seed", "'1.5'"),
    ("run random_walk --stop-time soon", "'soon'"),
    ("run random_walk --stop-time", "--stop-time"),
    (f"{RUN} --speed 0", "--speed 0", "window"),
    (f"{RUN} --set =5", "NAME=VALUE"),
    (f"{RUN} --set robots.7.mass=1", "robots.7", "0 to 1"),
    (f"{RUN} --set robots..mass=1", "'robots.'", "0 to 1"),
    (f"{RUN} --set 'robots.*.mass=1+1/2'", "'1+1/2'", "a number"),
    ("run follow_the_leader --headless --set folowers=2", "'folowers'", "'followers'"),
    (f"{RUN} --figure a.bmp", "--figure a.bmp", ".png"),
    (f"{RUN} --at 1,2", "--at", "--figure"),
    (f"{RUN} --figure a.png --at nan", "--at nan", "0 to 2 s"),
    (f"{RUN} --video a.gif --size 0x0", "(0, 0)", "64 x 64"),
    (f"{RUN} --video a.gif --from -5", "-5"),
    ("play corner_gam", "did you mean 'corner_game'?"),
    ("play sumo --role red,blue,red", "two people at most"),
    ("check pursuers/ahead.py --for corner_game --role pursuers", "did you mean 'pursuer'?"),
    ("check a.py --for random_walk --role red", "random_walk", "who has won"),
    ("edit random_walk", "no display"),
    ("compare head_on --set physics=stop", "--set physics"),
    ("compare", "EXPERIMENT"),
    ("replay random_walk", "random_walk"),
    ("check plan.dwg", "plan.dwg", ".py", ".dxf"),
    ("paper /dev/null --only 2", "/dev/null", "folder"),
    ("paper mine --only 2", "mine", "notes.txt"),
    ("sweep", "EXPERIMENT"),
    ("sweep random_walk --out mine/notes.txt", "--out mine/notes.txt", ".csv"),
    ("sweep random_walk --set samplng_time=1,2", "'sampling_time'"),
    ("sweep nothing.csv", "nothing.csv", "No such file"),
    ("tournament", "SCENARIO"),
    ("tournament sumo --players mine", "mine"),
    ("tournament sumo --players mine --tick-limit 0", "tick", "0"),
    ("plot", "RECORD"),
    ("plot random_walk", "random_walk", "run it first"),
]
"""Commands and options of every verb, mistyped or that can't be followed."""

HEAD = "from mars2d import *\nfrom mars2d.addons import *\n"

ROBOT = "format = 1\n[[robots]]\n"

FILES = [
    ("bad.py", "", "scenario = Scenario(...)"),
    ("bad.py", "x = 1\0\n", "bad.py", "null bytes"),
    ("bad.py", "def f():\nx = 1\n", "line 2", "indent"),
    ("bad.py", "import nmpy\n", "line 1", "nmpy"),
    ("bad.py", "raise SystemExit\n", "line 1", "SystemExit"),
    ("bad.py", "if 1 > 0:\n    raise AssertionError\n", "line 2", "AssertionError"),
    ("bad.py", HEAD + "scenario = Scenario()\ncontrol = 5\n", "control = 5", "a function"),
    ("bad.py", HEAD + "scenario = Scenario(stop_time=1)\ndef checks(record): return 5\n",
     "line 4", "checks returned 5", "Prediction"),
    ("bad.py", HEAD + "class Mine(Addon):\n    def on_stepp(self, world): pass\n", "line 3",
     "Mine.on_stepp", "'on_step'"),
    ("bad.py", HEAD + "Map.from_file('a.svg', unti='m')\n", "line 3", "unti"),
    ("bad.toml", "", "format = 1"),
    ("bad.toml", "format = '1'\n", "format = '1'"),
    ("bad.toml", "format = 1\nformat = 1\n", "line 2"),
    ("bad.toml", f"{ROBOT}mass = nan\n", "line 3", "mass = nan", "a number"),
    ("bad.toml", f"{ROBOT}drive = 'Unicylce'\n", "line 3", "'Unicylce'", "'Unicycle'"),
    ("bad.toml", f"{ROBOT}sensors = ['Proximity']\n", "line 3", "range"),
    ("bad.toml", f"{ROBOT}controller = 'nobody.py:f'\n", "nobody.py", "no such file"),
    ("bad.toml", "format = 1\ncontrol = 'no.py'\n", "line 2", "no.py"),
    ("bad.csv", "", "bad.csv"),
    ("bad.svg", "<html></html>", "bad.svg"),
    ("bad.npz", "time, x, y\nnot, a, run\n", "bad.npz"),
    ("bad.mcap", "no log", "bad.mcap"),
]  # fmt: skip
"""Files that are no experiments, scenarios, studies, maps or records, or broken ones."""


@pytest.fixture
def fails(tmp_path, monkeypatch, capsys):
    """Return a function that gives a command, and checks what is said of it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)

    def check(command, words):
        try:
            code = main(shlex.split(command))
        except SystemExit as leaving:
            code = leaving.code
        out, err = capsys.readouterr()
        lines = err.splitlines()
        assert code == 2, err
        assert "Traceback" not in out + err
        assert 1 <= len(lines) <= 3, err
        assert max(map(len, lines)) <= 600, err
        assert err.replace("\n", "").isprintable(), err
        assert [word for word in words if word not in err] == [], err
        assert all(line.startswith("mars2d: ") for line in lines), err

    return check


@each_case("row", COMMANDS)
def test_a_command_that_can_not_be_followed(fails, row):
    command, *words = row
    Path("mine").mkdir(exist_ok=True)
    Path("mine/notes.txt").write_text("mine")
    Path("a.npz").mkdir(exist_ok=True)
    fails(command, words)


@each_case("row", FILES)
def test_a_file_that_can_not_be_used(fails, row):
    name, text, *words = row
    Path(name).write_text(text)
    verb = {"py": "run", "toml": "run", "csv": "sweep"}.get(name.partition(".")[2], "check")
    fails(f"{verb} {name}{' --headless' * (verb == 'run')}", words)
