"""What laws return, and scripts give, that is no command."""

from __future__ import annotations

from tests.cli.bad_inputs.case import experiment, script

OF_A_ROBOT = [
    ("nothing returned", "None", "returned nothing"),
    ("a NaN", "(0.1, np.nan)", "returned", "nan", "finite"),
    ("an infinite speed", "(np.inf, 0)", "returned", "inf", "finite"),
    ("a number of 400 digits", "(10**400, 0)", "returned"),
    ("one number", "0.5", "returned 0.5", "two numbers"),
    ("a list of one", "[0.5]", "returned [0.5]", "two numbers"),
    ("three numbers", "(1, 2, 3)", "returned (1, 2, 3)", "two numbers"),
    ("an empty list", "[]", "returned []", "two numbers"),
    ("text", "'12'", "returned '12'", "two numbers"),
    ("two texts", "('0.1', '0')", "returned ('0.1', '0')", "two numbers"),
    ("complex numbers", "(1j, 0)", "returned (1j, 0)", "two numbers"),
    ("truths", "(True, False)", "returned (True, False)", "two numbers"),
    ("a set", "{0.1, 0.2}", "returned {0.", "two numbers"),
    ("a dict", "{'v': 0.1, 'omega': 0}", "returned {'v'", "two numbers"),
    ("a matrix", "np.zeros((2, 2))", "two numbers"),
    ("None in it", "(None, 0)", "returned (None, 0)", "two numbers"),
    ("a function", "print", "returned <built-in", "two numbers"),
    ("a robot", "robot", "returned", "two numbers"),
    ("a thing that can't be shown", "type('X', (), {'__repr__': lambda s: 1 / 0})()",
     "repr raises ZeroDivisionError", "two numbers"),
    ("a thing of many lines", "type('X', (), {'__repr__': lambda s: 'a\\nb' * 99})()",
     "two numbers"),
    ("words of an array", "np.array(['a', 'b'])", "two numbers"),
]  # fmt: skip

OF_A_TEAM = [
    ("one column for three", "[0.1, 0]", "(2, 3)"),
    ("rows for columns", "np.zeros((3, 2))", "(3, 2)", "(2, 3)", "transpose"),
    ("two columns for three", "np.zeros((2, 2))", "(2, 2)", "(2, 3)"),
    ("poses for commands", "world.pose", "(3, 3)", "(2, 3)"),
    ("a NaN in the second column", "[[0, np.nan, 0], [0, 0, 0]]", "nan", "robot 1"),
    ("an infinite spin of the last", "[[0, 0, 0], [0, 0, np.inf]]", "inf", "robot 2"),
    ("rows of unequal length", "[[1, 2, 3], [1]]", "[[1, 2, 3], [1]]", "(2, 3)"),
    ("a truth for all", "True", "True", "(2, 3)"),
    ("nothing for all", "None", "nothing"),
    ("a generator for all", "(0 for _ in range(6))", "(2, 3)"),
    ("a list of dicts", "[{}, {}]", "(2, 3)"),
]

OF_SCRIPTS = [
    ("a step's NaN", "World(Scenario()).step([np.nan, 0])", "nan", "finite"),
    ("a step's word", "World(Scenario()).step('ahead')", "'ahead'"),
    ("a step's three rows", "World(Scenario()).step(np.zeros((3, 1)))", "(3, 1)", "(2, 1)"),
    ("a step's truths", "World(Scenario()).step([True, False])", "True"),
    ("a step's number too many", "World(Scenario(robots=2)).step([1, 2, 3])", "(2, 2)"),
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
