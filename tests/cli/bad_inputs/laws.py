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
    ("a misspelt attribute", "return world.posee", "posee", "did you mean 'pose'?"),
    ("a division by zero", "return 1 / 0", "ZeroDivisionError"),
    ("a robot too many", "return world.robots[2].pose", "2"),
    ("a column too many", "return world.pose[:, 5]", "IndexError", "5"),
    ("shapes that do not fit", "return world.pose @ world.pose", "ValueError"),
    ("a pose that is written", "world.pose[0] = 1", "read-only"),
    ("a pose that is set", "world.pose = 0", "pose"),
    ("a time that is set", "world.time = 5", "time"),
    ("a step within a step", "world.step()", "step"),
    ("an exit in a law", "raise SystemExit(0)", "SystemExit"),
    ("an error of the user's", "raise KeyError('goal')", "KeyError: 'goal'"),
    ("an error with line breaks", "raise ValueError('a\\nb\\x1b[2J')", "ValueError"),
    ("an error without a text", "raise StopIteration", "StopIteration"),
    ("a law without an end", "return control(world)", "RecursionError"),
    ("an addition of words", "return world.time + 's'", "TypeError"),
    ("a key that is not there", "return {}['gain']", "KeyError: 'gain'"),
    ("an import that is not there", "import scpy", "scpy"),
    ("a file that is not there", "return open('plan.txt')", "FileNotFoundError", "plan.txt"),
    ("an add-on that is not there", "return world.addons.voronoi", "'voronoi'"),
    ("a matrix that has no inverse", "return np.linalg.inv(np.zeros((2, 2)))", "LinAlgError"),
    ("a random number of a word", "return world.rng.uniform('a')", "line 10"),
]

OF_ROBOTS = [
    ("a misspelt reading", "return robot.sense.proximty", "'proximty'", "'proximity'"),
    ("a misspelt property", "return robot.possition", "possition", "'position'"),
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
