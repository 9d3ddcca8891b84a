"""Laws that raise, ask for what is not there, or are of a form that is refused."""

from __future__ import annotations

from tests.cli.bad_inputs.case import experiment

TEAM = "scenario = Scenario(robots=2)\ndef control(world):\n    "  # line 10

ONE = "def law(robot):\n    @\n"
WITH = """\
seeing = Robot(sensors=[Proximity(range=1)], controller=law@)
scenario = Scenario(robots=[seeing, Robot(pose=(2, 0, 0))])"""

OF_TEAMS = [
    ("a misspelt variable", "return wrold.pose[:2]", "wrold", "did you mean 'world'?"),
    ("a division by zero", "return 1 / 0", "ZeroDivisionError"),
    ("a time that is set", "world.time = 5", "time"),
    ("an exit in a law", "raise SystemExit(0)", "SystemExit"),
    ("an error with line breaks", "raise ValueError('a\\nb\\x1b[2J')", "ValueError"),
    ("a law without an end", "return control(world)", "RecursionError"),
]

OF_ROBOTS = [
    ("a misspelt reading", "return robot.sense.proximty", "'proximty'", "'proximity'"),
    ("a generator that yields nothing", "yield", "nothing"),
]

UNSEEN = [
    ("a pose with sensors alone", "return robot.pose[:2]", "sensors", "pose"),
    ("headings with positions alone", "return robot.neighbours[0].pose", "positions", "pose"),
]

FORMS = [("a law that is a class", "class control: pass", "control")]


def _one(name: str, code: str, *words: str, sees: str = "full"):
    text = ONE.replace("@", code) + WITH.replace("@", f", sees={sees!r}")
    return experiment(name, text, "line", *words)


CASES = [
    *(experiment(name, TEAM + code, "line 10", *words) for name, code, *words in OF_TEAMS),
    *(_one(name, code, *words) for name, code, *words in OF_ROBOTS),
    *(_one(name, code, *words, sees=sees) for name, code, sees, *words in UNSEEN),
    *(experiment(n, f"scenario = Scenario()\n{code}", *words) for n, code, *words in FORMS),
]
