"""What laws return, and scripts give, that is no command."""

from __future__ import annotations

from tests.cli.bad_inputs.case import experiment, script

OF_A_ROBOT = [
    ("nothing returned", "None", "returned nothing"),
    ("a number of 400 digits", "(10**400, 0)", "returned"),
    ("three numbers", "(1, 2, 3)", "returned (1, 2, 3)", "two numbers"),
    ("two texts", "('0.1', '0')", "returned ('0.1', '0')", "two numbers"),
    ("a set", "{0.1, 0.2}", "returned {0.", "two numbers"),
    ("None in it", "(None, 0)", "returned (None, 0)", "two numbers"),
]

OF_A_TEAM = [
    ("one column for three", "[0.1, 0]", "(2, 3)"),
    ("two columns for three", "np.zeros((2, 2))", "(2, 2)", "(2, 3)"),
    ("a NaN in the second column", "[[0, np.nan, 0], [0, 0, 0]]", "nan", "robot 1"),
    ("rows of unequal length", "[[1, 2, 3], [1]]", "[[1, 2, 3], [1]]", "(2, 3)"),
    ("nothing for all", "None", "nothing"),
    ("a list of dicts", "[{}, {}]", "(2, 3)"),
]

OF_SCRIPTS = [
    ("a step's NaN", "World(Scenario()).step([np.nan, 0])", "nan", "finite"),
    ("a step's truths", "World(Scenario()).step([True, False])", "True"),
]

CASES = [
    *(experiment(name, f"def law(robot):\n    return {code}\n"
                 "scenario = Scenario(robots=[Robot(controller=law)])", "line", "law", *words)
      for name, code, *words in OF_A_ROBOT),
    *(experiment(name, "scenario = Scenario(robots=3)\n"
                 f"def control(world):\n    return {code}", "line", "control", *words)
      for name, code, *words in OF_A_TEAM),
    *(script(name, code, *words) for name, code, *words in OF_SCRIPTS),
]  # fmt: skip
