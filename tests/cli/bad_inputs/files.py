"""Files that are no experiments, scenarios, laws or studies, or broken ones."""

from __future__ import annotations

from tests.cli.bad_inputs.case import HEAD, Case, Content, typed

GARBAGE = bytes((37 * k * k + 11 * k) % 256 for k in range(2000))

LAW = "def control(robot):\n    return 0.1, 0\n"

EXPERIMENTS: list[tuple[str, Content, tuple[str, ...]]] = [
    ("an empty experiment", "", ("scenario = Scenario(...)",)),
    ("an experiment with zero bytes", "x = 1\0\n", ("bad.py", "null bytes")),
    ("a scenario that is a number", "scenario = 5\n", ("scenario = 5", "Scenario")),
    ("a line that is not indented", "def f():\nx = 1\n", ("line 2", "indent")),
    ("a misspelt import", "import nmpy\n", ("line 1", "nmpy")),
    ("an exit without a fault", "raise SystemExit\n", ("line 1", "SystemExit")),
    ("an assertion", "if 1 > 0:\n    raise AssertionError\n", ("line 2", "AssertionError")),
    ("a law of a shape that is none", HEAD + "scenario = Scenario()\ncontrol = 5\n",
     ("control = 5", "a function")),
    ("checks that return a number", HEAD + "scenario = Scenario()\ndef checks(record): return 5\n",
     ("line 9", "checks returned 5", "Prediction")),
    ("a scenario function without a default", "def scenario(n):\n    pass\n", ("scenario", "'n'")),
    ("a hook that is none", HEAD + "class Mine(Addon):\n    def on_stepp(self, world): pass\n",
     ("line 8", "Mine.on_stepp", "'on_step'")),
]  # fmt: skip

ROBOT = "format = 1\n[[robots]]\n"

SCENARIOS = [
    ("an empty scenario file", "", "format = 1"),
    ("a scenario file of a version that is text", "format = '1'\n", "format = '1'"),
    ("a field twice", "format = 1\nformat = 1\n", "line 2"),
    ("a mass of NaN in a file", f"{ROBOT}mass = nan\n", "line 3", "mass = nan", "a number"),
    ("a drive that is none", f"{ROBOT}drive = 'Unicylce'\n", "line 3", "'Unicylce'", "'Unicycle'"),
    ("a sensor without a field", f"{ROBOT}sensors = ['Proximity']\n", "line 3", "range"),
    ("a law that is not there", f"{ROBOT}controller = 'nobody.py:f'\n", "nobody.py",
     "no such file"),
    ("a team's law that is not there", "format = 1\ncontrol = 'no.py'\n", "line 2", "no.py"),
    ("a folder for a scenario file", None, "folder"),
]  # fmt: skip

STUDY = "row,experiment,n,seed,end_time,digest,code,error\r\n1,walk.py,2,0,5.0,ab,cd,\r\n"

STUDIES = [
    ("an empty study", "", "a.csv"),
    ("a study of bytes", GARBAGE, "a.csv"),
    ("a study with a word for a row", STUDY.replace("1,walk", "one,walk"), "a.csv", "'one'"),
]

LAWS = [
    ("a player that breaks off", "def control(robot:\n", "line 1"),
    ("a player without a law", "x = 1\n", "control"),
]


def _experiments() -> list[Case]:
    run = "mars2d run bad.py --headless --stop-time 0.5"
    return [
        Case(name, run, ("bad.py", *words), {"bad.py": code}) for name, code, words in EXPERIMENTS
    ]


def _scenario_files() -> list[Case]:
    run = "mars2d run bad.toml --headless --stop-time 0.5"
    return [
        Case(n, run, tuple(words), {"bad.toml": text, "law.py": LAW})
        for n, text, *words in SCENARIOS
    ]


CASES = [
    *_experiments(),
    *_scenario_files(),
    *(typed(n, "mars2d sweep a.csv", *words, a__csv=text) for n, text, *words in STUDIES),
    typed("a study over another", "mars2d sweep random_walk --out a.csv", "a.csv", "another",
          a__csv=STUDY),
    typed("a study over notes", "mars2d sweep random_walk --out a.csv", "a.csv",
          a__csv="my notes\n"),
    typed("a paper over a folder of one's own", "mars2d paper out --only 2", "out", "notes.txt",
          **{"out/notes__txt": "mine"}),
    typed("a check of a broken experiment", "mars2d check bad.py", "bad.py, line 1",
          bad__py="x = (\n"),
    typed("a check of an empty file", "mars2d check bad.py", "bad.py", "scenario", bad__py=""),
    typed("a tournament of broken files", "mars2d tournament sumo --players nothing",
          "nothing", **{"nothing/readme__txt": "no laws"}),
    typed("a tournament into notes", "mars2d tournament sumo --players players --out out",
          "out", "notes.txt", **{"out/notes__txt": "mine"}),
    typed("a page in a folder", "mars2d run random_walk --headless --html a.html", "a.html",
          "folder",
          a__html=None),
    typed("a record in a file that is a folder", "mars2d run random_walk --headless --record a.npz",
          "a.npz", "folder", a__npz=None),
]  # fmt: skip
