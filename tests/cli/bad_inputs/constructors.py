"""Values that a scenario's objects can't have, in an experiment that is run."""

from __future__ import annotations

from tests.cli.bad_inputs.case import experiment, script

ROBOT = [
    ("a diameter below 0", "diameter=-0.3", "Robot.diameter = -0.3", ">= 0.001"),
    ("a diameter that is text", "diameter='0.3'", "Robot.diameter = '0.3'", "a number"),
    ("a diameter of NaN", "diameter=np.nan", "Robot.diameter = nan", "a number"),
    ("a diameter of an array", "diameter=np.array([0.3])", "Robot.diameter = array", "a number"),
    ("a mass of 0", "mass=0", "Robot.mass = 0", ">= 1e-06"),
    ("a mass without end", "mass=float('inf')", "Robot.mass = inf", "<= 1e+06"),
    ("a mass of 400 digits", "mass=10**400", "Robot.mass = 1000", "a number"),
    ("a mass that is truth", "mass=True", "Robot.mass = True", "a number"),
    ("a complex moment", "moment=1j", "Robot.moment = 1j", "a number"),
    ("a misspelt material", "friction='wod'", "Robot.friction = 'wod'", "'wood'"),
    ("too elastic a robot", "restitution=1.5", "Robot.restitution = 1.5", "<= 1"),
    ("a misspelt field", "diametr=0.3", "'diametr'", "did you mean 'diameter'?"),
    ("a pose of one number", "pose=(0,)", "Robot.pose = (0,)", "(x, y, theta)"),
    ("a pose of text", "pose='origin'", "Robot.pose = 'origin'", "(x, y, theta)"),
    ("a pose without end", "pose=(0, np.inf, 0)", "Robot.pose = (0, inf, 0)", "finite"),
    ("a pose of another planet", "pose=(1e9, 0, 0)", "Robot.pose", "1000000000.0", "+-1e+06"),
    ("a class for a drive", "drive=Unicycle", "Robot.drive", "Unicycle(...)"),
    ("a word for a drive", "drive='Unicycle'", "Robot.drive = 'Unicycle'", "Unicycle()"),
    ("no drive", "drive=None", "Robot.drive = None", "Unicycle()"),
    ("a colour that is none", "color='bleu'", "Robot.color = 'bleu'", "did you mean 'blue'?"),
    ("a name that is a number", "name=7", "Robot.name = 7", "text in quotes"),
    ("a name with a line break", "name='a\\nb'", "Robot.name = 'a\\nb'", "one line"),
    ("a name with a terminal's code", "name='\\x1b[2J'", "Robot.name", "one line"),
    ("a sensor without a list", "sensors=Proximity(range=1)", "Robot.sensors", "a list"),
    ("a sensor's class", "sensors=[Proximity]", "Robot.sensors[0]", "Proximity(...)"),
    ("a law that is no function", "controller='law'", "Robot.controller = 'law'", "a function"),
    ("a law without arguments", "controller=lambda: 0", "Robot.controller", "the robot"),
    ("an unknown information", "sees='all'", "Robot.sees = 'all'", "'full'"),
    ("an offset beyond the rim", "center_offset=0.2", "Robot.center_offset = 0.2", "0.15 m"),
    ("a shape and a diameter", "shape=Disc(0.2), diameter=0.2", "Robot.diameter", "shape"),
]

SCENARIO = [
    ("a sampling time of 0", "sampling_time=0", "Scenario.sampling_time = 0", ">= 1e-06"),
    ("a sampling time of None", "sampling_time=None", "Scenario.sampling_time = None", "a number"),
    ("a stop time before 0", "stop_time=-1", "Scenario.stop_time = -1", ">= 0"),
    ("a delay of NaN", "command_delay=np.nan", "Scenario.command_delay = nan", "a number"),
    ("physics that are none", "physics='contacts'", "Scenario.physics", "'contact'"),
    ("an exit in capitals", "on_exit='Wall'", "Scenario.on_exit = 'Wall'", "'wall'"),
    ("a workspace of two corners", "workspace=[(0, 0), (1, 1)]", "Scenario.workspace", "2"),
    ("a workspace that crosses itself", "workspace=[(-2, -2), (2, 2), (2, -2), (-2, 2)]",
     "Scenario.workspace", "crosses", "(0, 0)"),
    ("a workspace that is a number", "workspace=10", "Scenario.workspace = 10", "vertices"),
    ("robots without a list", "robots=Robot()", "Scenario.robots", "a list"),
    ("no robots", "robots=0", "Scenario.robots", "0"),
    ("a milliard of robots", "robots=10**9", "Scenario.robots", "1000000000"),
    ("a robot's class", "robots=[Robot]", "Scenario.robots[0]", "Robot(...)"),
    ("None among the robots", "robots=[Robot(), None]", "Scenario.robots", "None"),
    ("robots of one name", "robots=[Robot(name='a'), Robot(name='a', pose=(1, 0, 0))]", "'a'"),
    ("robots in each other", "robots=[Robot(), Robot(pose=(0.1, 0, 0))]", "robot0", "robot1"),
    ("a robot outside", "robots=[Robot(pose=(9, 0, 0))]", "robot0", "workspace", "(9"),
    ("a title that is none", "title=None", "Scenario.title = None", "text in quotes"),
    ("a title with a line break", "title='a\\nb'", "Scenario.title = 'a\\nb'", "one line"),
    ("an add-on without a list", "addons=Trails()", "Scenario.addons", "a list"),
    ("add-ons of one name", "addons=[Trails(), Trails()]", "'trails'"),
    ("looks as a dict", "animation={'grid': False}", "Scenario.animation", "Animation()"),
    ("a speed below 0", "animation=Animation(playback_speed=-1)", "playback_speed = -1", "'max'"),
    ("a line style that is none", "animation=Animation(wake_style='~')", "wake_style = '~'"),
    ("neighbours by a word", "neighbours='Delauny'", "Scenario.neighbours", "Delaunay()"),
    ("neighbours at a distance below 0", "neighbours=Within(-1)", "Within", "-1"),
    ("a box in a robot", "props=[Box()]", "box0", "robot0"),
    ("a box of no mass", "props=[Box(pose=(2, 0), mass=0)]", "Box.mass = 0", ">= 1e-06"),
    ("a prop's misspelt field", "props=[Box(pose=(2, 0), lenght=1)]", "'lenght'", "'length'"),
    ("a rope to nobody", "joints=[Rope(a='robot0', b='robt1')]", ".b = 'robt1'", "robot0"),
    ("a rope too short", "joints=[Rope(a='robot0', anchor_b=(2, 0), length=1)]", "length", "2"),
    ("a spring of no stiffness", "joints=[Spring(a='robot0', anchor_b=(2, 0), stiffness=0)]",
     "Spring.stiffness = 0", "> 0"),
    ("an outline of one point", "addons=[Map([[(1, 1)]])]", "Map.outlines[0]", "1"),
    ("an outline that crosses itself", "addons=[Map([[(1, 1), (2, 2), (2, 1), (1, 2)]])]",
     "Map.outlines[0]", "crosses", "(1.5, 1.5)"),
    ("a start in an obstacle", "addons=[Map([[(-1, -1), (1, -1), (0, 2)]])]", "robot0", "inside"),
    ("a game without roles", "addons=[Game()]", "Game.roles"),
    ("a ring of radius 0", "addons=[Ring({'a': [0], 'b': [1]}, radius=0)]", "Ring", "radius"),
    ("waypoints of nobody", "addons=[Waypoints({'robt0': [(1, 1)]})]", "robt0",
     "one list of points for each robot"),
]  # fmt: skip

SCRIPTS = [
    ("a world of nothing", "World(None)", "scenario = None", "Scenario"),
    ("a world's class", "World(Scenario)", "Scenario"),
    ("a world's seed below 0", "World(Scenario(), seed=-1)", "seed = -1", "whole number"),
    ("a run's unknown physics", "run(Scenario(), options={'physic': 'stop'})", "'physics'"),
    ("a run of a number", "run(5)", "experiment = 5", "expected a file"),
    ("a run's speed below 0", "run(Scenario(), speed=-2)", "speed = -2"),
    ("a replacement that is misspelt", "Robot().replace(mas=2)", "'mas'", "'mass'"),
    ("a run of options in a list", "run(Scenario(), options=['physics'])", "options", "a dict"),
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
