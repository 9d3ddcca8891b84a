"""Values that a scenario's objects can't have, in an experiment that is run."""

from __future__ import annotations

from tests.cli.bad_inputs.case import experiment, script

ROBOT = [
    ("a diameter below 0", "diameter=-0.3", "Robot.diameter = -0.3", ">= 0.001"),
    ("a diameter of an array", "diameter=np.array([0.3])", "Robot.diameter = array", "a number"),
    ("a mass of 400 digits", "mass=10**400", "Robot.mass = 1000", "a number"),
    ("a misspelt material", "friction='wod'", "Robot.friction = 'wod'", "'wood'"),
    ("a pose of one number", "pose=(0,)", "Robot.pose = (0,)", "(x, y, theta)"),
    ("a pose of another planet", "pose=(1e9, 0, 0)", "Robot.pose", "1000000000.0", "+-1e+06"),
    ("no drive", "drive=None", "Robot.drive = None", "Unicycle()"),
    ("a name with a line break", "name='a\\nb'", "Robot.name = 'a\\nb'", "one line"),
    ("a sensor's class", "sensors=[Proximity]", "Robot.sensors[0]", "Proximity(...)"),
    ("an unknown information", "sees='all'", "Robot.sees = 'all'", "'full'"),
]

SCENARIO = [
    ("a sampling time of 0", "sampling_time=0", "Scenario.sampling_time = 0", ">= 1e-06"),
    ("a delay of NaN", "command_delay=np.nan", "Scenario.command_delay = nan", "a number"),
    ("a workspace of two corners", "workspace=[(0, 0), (1, 1)]", "Scenario.workspace", "2"),
    ("robots without a list", "robots=Robot()", "Scenario.robots", "a list"),
    ("a robot's class", "robots=[Robot]", "Scenario.robots[0]", "Robot(...)"),
    ("robots in each other", "robots=[Robot(), Robot(pose=(0.1, 0, 0))]", "robot0", "robot1"),
    ("a title with a line break", "title='a\\nb'", "Scenario.title = 'a\\nb'", "one line"),
    ("looks as a dict", "animation={'grid': False}", "Scenario.animation", "Animation()"),
    ("neighbours by a word", "neighbours='Delauny'", "Scenario.neighbours", "Delaunay()"),
    ("a box of no mass", "props=[Box(pose=(2, 0), mass=0)]", "Box.mass = 0", ">= 1e-06"),
    ("a rope too short", "joints=[Rope(a='robot0', anchor_b=(2, 0), length=1)]", "length", "2"),
    ("an outline that crosses itself", "addons=[Map([[(1, 1), (2, 2), (2, 1), (1, 2)]])]",
     "Map.outlines[0]", "crosses", "(1.5, 1.5)"),
    ("a ring of radius 0", "addons=[Ring({'a': [0], 'b': [1]}, radius=0)]", "Ring", "radius"),
]  # fmt: skip

SCRIPTS = [
    ("a world of nothing", "World(None)", "scenario = None", "Scenario"),
    ("a world's seed below 0", "World(Scenario(), seed=-1)", "seed = -1", "whole number"),
    ("a run of a number", "run(5)", "experiment = 5", "expected a file"),
    ("a replacement that is misspelt", "Robot().replace(mas=2)", "'mas'", "'mass'"),
]

LATER = [
    ("a game of nobody", "Game({'a': ['robot0'], 'b': ['nobody']})", "nobody", "robot0"),
    ("a density below 0", "Density(lambda x, y: -1.0), Voronoi()", "Density.function", "-1"),
    ("a floor's missing image", "Floor(image='flor.png', bounds=(0, 1, 0, 1))",
     "flor.png", "no such file"),
]  # fmt: skip
"""What is only seen when the world is made: of these no line is known."""

CASES = [
    *(experiment(n, f"scenario = Scenario(addons=[{code}])", *words) for n, code, *words in LATER),
    *(experiment(n, f"scenario = Scenario(robots=[Robot({code})])", "line 8", *words)
      for n, code, *words in ROBOT),
    *(experiment(n, f"scenario = Scenario({code})", "line 8", *words)
      for n, code, *words in SCENARIO),
    *(script(n, code, *words) for n, code, *words in SCRIPTS),
]  # fmt: skip
