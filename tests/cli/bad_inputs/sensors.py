"""Sensors, and add-ons, of the user's own that read nonsense, fail, or can't be made."""

from __future__ import annotations

from tests.cli.bad_inputs.case import HEAD, Case, experiment, typed

READ = """class Mine(Sensor):
    def read(self, robot, world, rng):
        return {code}
scenario = Scenario(robots=[Robot(sensors=[Mine()])])"""  # it reads in line 10

READINGS = [
    ("a reading that fails", "1 / 0", "ZeroDivisionError"),
    ("a reading of text", "'near'", "'near'"),
    ("a reading of nothing", "None", "read None"),
    ("a reading of a dict", "{'d': 1}", "{'d': 1}"),
    ("a reading of objects", "[object()]", "object"),
    ("a complex reading", "1j", "1j"),
    ("a reading that grows", "np.zeros(int(10 * world.time) + 1)", "shape", "(1,)", "(2,)"),
    ("a reading of unequal rows", "[[1, 2], [3]]", "[[1, 2], [3]]"),
    ("a reading that turns to text", "'x' if world.time > 0.2 else 1.0", "'x'"),
    ("a reading that steps the world", "world.step()", "step"),
    ("a reading of a misspelt thing", "world.distnce((0, 0), 1, 0)", "distnce", "'distance'"),
    ("a ray from nowhere", "world.ray((np.nan, 0), 0, 1, 0)", "start = (nan, 0)", "finite"),
    ("a ray to nowhere", "world.ray((0, 0), np.inf, 1, 0)", "angle = inf", "finite"),
    ("a ray of a length below 0", "world.ray((0, 0), 0, -1, 0)", "length = -1", "at least 0 m"),
    ("rays to nowhere", "world.rays((0, 0), [0, np.nan], 1, 0)", "bearings = [ 0. nan]", "finite"),
    ("a point nowhere", "world.distance((0, np.nan), 1, 0)", "point = (0, nan)", "finite"),
    ("a limit of NaN", "world.distance((0, 0), np.nan, 0)", "limit = nan", "at least 0 m"),
    ("a colour of nobody", "world.color(99)", "IndexError"),
    ("a reading that leaves", "exit()", "SystemExit"),
    ("a reading of other robots' sense", "robot.sense.mine", "mine"),
]

FIELDS = [
    ("a proximity sensor without a range", "Proximity()", "Proximity", "range"),
    ("a range of 0", "Proximity(range=0)", "Proximity.range = 0", "> 0"),
    ("a range of NaN", "RangeFinder(range=np.nan)", "RangeFinder.range = nan", "a number"),
    ("half a beam", "RangeFinder(beams=0.5)", "RangeFinder.beams = 0.5", "whole number"),
    ("no beams", "RangeFinder(beams=0)", "RangeFinder.beams = 0", "1 to 100000"),
    ("a milliard of beams", "RangeFinder(beams=10**9)", "RangeFinder.beams", "100000"),
    ("more than a turn", "RangeFinder(field_of_view=7)", "field_of_view = 7", "2 pi"),
    ("a noise below 0", "RangeFinder(noise=-1)", "RangeFinder.noise = -1", "0"),
    ("noises of another number", "Pose(noise=(1, 2))", "Pose.noise = (1.0, 2.0)", "3"),
    ("a rate of 0", "Pose(rate=0)", "Pose.rate = 0", "> 0"),
    ("a latency below 0", "Pose(latency=-1)", "Pose.latency = -1", ">= 0"),
    ("a mount of one number", "Pose(mount=(1,))", "Pose.mount = (1,)", "theta"),
    ("dropouts of two", "Pose(dropouts=2)", "Pose.dropouts = 2", "<= 1"),
    ("a name of two words", "Pose(name='my pose')", "Pose.name = 'my pose'", "robot.sense."),
    ("a misspelt sensor's field", "Pose(nois=1)", "'nois'", "did you mean 'noise'?"),
    ("a sensor's field without its name", "Proximity(1)", "Proximity"),
    ("two sensors of a name", "Pose(), Pose()", "'pose'"),
    ("a ring of no sonars", "SonarRing(sonars=0)", "SonarRing"),
    ("an add-on for a sensor", "Map([])", "Robot.sensors", "Map"),
]

ADDON = """class Mine(Addon):
    def {code}
scenario = Scenario(addons=[Mine()])"""

HOOKS = [
    ("an add-on that fails at the start", "on_start(self, world): {}['x']", "KeyError"),
    ("an add-on that fails later", "on_step(self, world): 1 / (world.iteration - 2)", "ZeroDiv"),
    ("an add-on that fails once sensed", "on_sensed(self, world): world.robts", "'robots'"),
    ("an add-on that fails at the end", "on_stop(self, world): raise OSError('full')", "full"),
    ("an add-on that steps", "on_step(self, world): world.step()", "step"),
    ("a hook without the world", "on_step(self): pass", "on_step"),
    ("a hook of another name", "on_stepp(self, world): pass", "'on_step'"),
    ("obstacles of NaN", "obstacles(self): return [[(np.nan, 0), (1, 1)]]", "nan"),
    ("no obstacles", "obstacles(self): return None", "obstacles", "None"),
    ("obstacles that fail", "obstacles(self): return 1 / 0", "ZeroDivisionError"),
    ("an add-on that leaves", "on_step(self, world): exit(0)", "SystemExit"),
    ("an add-on that stops without a word", "on_step(self, world): world.stop()", "stop"),
]

CHECKED = [
    ("a checked sensor of text", READ.format(code="'near'"), "'near'"),
    ("a checked sensor that fails", READ.format(code="1 / 0"), "ZeroDivisionError"),
    ("a checked add-on that fails", ADDON.format(code="on_step(self, world): 1 / 0"), "ZeroDiv"),
]


def _checked(name: str, code: str, *words: str) -> Case:
    return typed(name, "mars2d check bad.py", "bad.py", *words, bad__py=HEAD + code + "\n")


CASES = [
    *(experiment(name, READ.format(code=code), "line", "'mine'", *words)
      for name, code, *words in READINGS),
    *(experiment(name, f"scenario = Scenario(robots=[Robot(sensors=[{code}])])", "line 8", *words)
      for name, code, *words in FIELDS),
    *(experiment(name, ADDON.format(code=code), "line", *words) for name, code, *words in HOOKS),
    *(_checked(*row) for row in CHECKED),
]  # fmt: skip
