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
    ("a sensor that it has not", "return robot.sense.camera", "'camera'", "proximity"),
    ("a neighbour too many", "return robot.neighbours[3].pose[:2]", "IndexError"),
    ("a misspelt property", "return robot.possition", "possition", "'position'"),
    ("a robot's pose that is set", "robot.pose = (0, 0, 0)", "pose"),
    ("a memory that is not there", "return robot.memory.gaol", "gaol"),
    ("a generator that yields nothing", "yield", "nothing"),
    ("a generator that fails", "yield 0.1, 0\n    yield 1 / 0", "ZeroDivisionError"),
    ("an unpacking of three", "x, y = robot.pose", "ValueError", "unpack"),
]

UNSEEN = [
    ("a pose with sensors alone", "return robot.pose[:2]", "sensors", "pose"),
    ("neighbours with sensors alone", "return robot.neighbours", "sensors", "neighbours"),
    ("all robots in part", "return robot.world.pose", "partial", "itself and its neighbours"),
    ("headings with positions alone", "return robot.neighbours[0].pose", "positions", "pose"),
]

FORMS = [
    ("a law that is a coroutine", "async def control(world): return 0, 0", "control"),
    ("a law of two arguments", "def control(world, gain): return 0, 0", "control", "the world"),
    ("a law of none", "def control(): return 0, 0", "control", "the world"),
    ("a law that is a class", "class control: pass", "control"),
    ("a law that is a module", "import math as control", "control", "a function"),
    ("a law with a keyword that must be given", "def control(world, *, gain): return 0, 0", "gain"),
    ("a law that is an asynchronous generator", "async def control(world): yield 0, 0", "control"),
    ("a law that is called already", "control = (lambda world: (0, 0))(None)", "control", "(0, 0)"),
]  # fmt: skip


def _one(name: str, code: str, *words: str, sees: str = "full"):
    text = ONE.replace("@", code) + WITH.replace("@", f", sees={sees!r}")
    return experiment(name, text, "line", *words)


CASES = [
    *(experiment(name, TEAM + code, "line 10", *words) for name, code, *words in OF_TEAMS),
    *(_one(name, code, *words) for name, code, *words in OF_ROBOTS),
    *(_one(name, code, *words, sees=sees) for name, code, sees, *words in UNSEEN),
    *(experiment(n, f"scenario = Scenario()\n{code}", *words) for n, code, *words in FORMS),
]
