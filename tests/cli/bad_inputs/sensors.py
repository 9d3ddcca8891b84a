"""Sensors, and add-ons, of the user's own that read nonsense, fail, or can't be made."""

from __future__ import annotations

from tests.cli.bad_inputs.case import HEAD, Case, experiment, typed

READ = """class Mine(Sensor):
    def read(self, robot, world, rng):
        return {code}
scenario = Scenario(robots=[Robot(sensors=[Mine()])])"""  # it reads in line 10

READINGS = [
    ("a reading that fails", "1 / 0", "ZeroDivisionError"),
    ("a reading of a dict", "{'d': 1}", "{'d': 1}"),
    ("a reading that grows", "np.zeros(int(10 * world.time) + 1)", "shape", "(1,)", "(2,)"),
    ("a reading that steps the world", "world.step()", "step"),
    ("a ray to nowhere", "world.ray((0, 0), np.inf, 1, 0)", "angle = inf", "finite"),
    ("a point nowhere", "world.distance((0, np.nan), 1, 0)", "point = (0, nan)", "finite"),
    ("a reading that leaves", "exit()", "SystemExit"),
]

FIELDS = [
    ("a proximity sensor without a range", "Proximity()", "Proximity", "range"),
    ("half a beam", "RangeFinder(beams=0.5)", "RangeFinder.beams = 0.5", "whole number"),
    ("more than a turn", "RangeFinder(field_of_view=7)", "field_of_view = 7", "2 pi"),
    ("a rate of 0", "Pose(rate=0)", "Pose.rate = 0", "> 0"),
    ("dropouts of two", "Pose(dropouts=2)", "Pose.dropouts = 2", "<= 1"),
    ("a sensor's field without its name", "Proximity(1)", "Proximity"),
    ("an add-on for a sensor", "Map([])", "Robot.sensors", "Map"),
]

ADDON = """class Mine(Addon):
    def {code}
scenario = Scenario(addons=[Mine()])"""

HOOKS = [
    ("an add-on that fails at the start", "on_start(self, world): {}['x']", "KeyError"),
    ("an add-on that fails at the end", "on_stop(self, world): raise OSError('full')", "full"),
    ("obstacles that fail", "obstacles(self): return 1 / 0", "ZeroDivisionError"),
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
