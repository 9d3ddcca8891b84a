"""Mistakes that newcomers make, each really made, and the words that the answer must have."""

import re
from pathlib import Path

import pytest

import mars2d
from mars2d import InputError
from mars2d.cli.command_line import main
from mars2d.core.extras import extra
from mars2d.sensors import Proximity
from tests.cases import each_case

HEAD = """\
import numpy as np
from mars2d import *
from mars2d.addons import Addon, Map
from mars2d.bodies import Ball, Box, Puck
from mars2d.sensors import Ground, Proximity, RangeFinder

"""

ROBOTS = [
    ("x=1", "no field 'x'; write pose=(x, y, theta)"),
    ("position=(1, 2)", "write pose=(x, y, theta)"),
    ("heading=1", "write pose=(x, y, theta)"),
    ("speed=1", "write drive=Unicycle(max_linear_speed=...)"),
    ("maxSpeed=1", "write drive=Unicycle(max_linear_speed=...)"),
    ("max_omega=1", "write drive=Unicycle(max_angular_speed=...)"),
    ("colour='red'", "did you mean 'color'?"),
    ("control=print", "did you mean 'controller'?|write controller=law"),
    ("sensor=[Proximity(range=1)]", "did you mean 'sensors'?"),
    ("sensors=Proximity(range=1)", "write [Proximity(range=1.0)]"),
    ("sensors=[Proximity]", "write Proximity(...)"),
    ("drive=Unicycle", "write Unicycle(...)"),
    ("pose=(0, 0, '90')", "expected a pose (x, y, theta) in metres and radians"),
    ("wheels_semiaxis_length=0.05", "write drive=Unicycle(wheel_semiaxis=...)"),
    ("distance_center_barycenter=0.05", "write center_offset=..."),
    ("radius=0.1", "write diameter=2 * radius"),
    ("drive=Unicycle(max_v=1)", "write max_linear_speed=..."),
    ("drive=Unicycle(max_omega=1)", "max_angular_speed=..."),
    ("drive=Unicycle(1)", "takes its fields by name, as in Unicycle(max_linear_speed=...)"),
    ("sensors=[Proximity(distance=3)]", "write range=..."),
    ("sensors=[Proximity(range=1, fov=3)]", "write field_of_view=..."),
]  # fmt: skip
"""Fields of a robot."""

SCENARIOS = [
    ("n=3", "write robots=3"),
    ("dt=0.1", "write sampling_time=..."),
    ("duration=10", "write stop_time=..."),
    ("laws=print", "def control(world) in the file"),
    ("obstacles=[[(0, 0), (1, 1), (1, 0)]]", "write addons=[Map("),
    ("arena=(3, 3)", "write workspace=[(x, y), ...]"),
    ("props=Box()", "write [Box()]"),
    ("sensors=[Proximity(range=1)]", "write Robot(sensors=[...])"),
    ("robots=Robot()", "write [Robot()]"),
    ("robots=[(0, 0, 0)]", "expected a Robot, such as Robot(pose=(0, 0, 0))"),
    ("robots=[Robot(), Robot(pose=(0.1, 0, 0))]", "they start 0.2 m inside each other"),
    ("addons=[Map([(0, 0), (1, 1)])]", "put one more pair of brackets round it"),
    ("robots=[Robot()], props=[Box(pose=(1, 0, 0), mass=99)]",
     "with 10 kg the drives, 5 N, push it on a ground_friction of less than 0.051 only"),
    ("neighbors=Within(3)", "did you mean 'neighbours'?"),
    ("robots=[Robot(mass=20), Robot(pose=(1, 0, 0), mass=1)]",
     "set the mass of robot0 to 10 kg or less, or that of robot1 to 2 kg or more"),
    ("on_exit='bounce'", "expected one of 'stop', 'wall', 'ignore'"),
    ("Initial_pose=[[1], [3], [0]]", "write robots=[Robot(pose=p) for p in P.T], with P (3, n)"),
    ("non_holonomic=False", "write Robot(drive=Holonomic())"),
    ("animation=Animation(enable=False)", "write speed=1 in mars2d.run(...) for a window"),
    ("animation=Animation(colors='rb')", "write base_colors=[...]"),
    ("on_exit='wrap'", "takes distances modulo the side"),
    ("periodic=True", "takes distances modulo the side"),
    ("physics='real'", "expected one of 'contact', 'stop', 'ideal'"),
    ("workspace=[(0, 0), (1, 1), (0, 1), (1, 0)]", "list its vertices in order"),
]  # fmt: skip
"""Fields of a scenario and what it holds."""

FILES = [
    ("from mars2d import Map", "write `from mars2d.addons import Map`"),
    ("from mars2d import Box", "write `from mars2d.bodies import Box`"),
    ("from mars2d import Lidar", "write RangeFinder, of mars2d.sensors"),
    ("from mars2d.addons import Wall", "write Map, of mars2d.addons"),
    ("from mars2d import Unicyle", "did you mean 'Unicycle'?"),
    ("from mars2d import holonomic", "write `from mars2d import Holonomic`"),
    ("from mars2d import Simulator", "mars2d.run(scenario)"),
    ("import mars2d.sensor", "did you mean 'mars2d.sensors'?"),
    ("from mars2d.sensor import Proximity", "did you mean 'mars2d.sensors'?"),
    ("a = Proximity(range=1)\nb = IMU()", "write `from mars2d.sensors import Imu` at the top"),
    ("a = math.pi", "write `import math` at the top"),
    ("a = plt.figure()", "write `import matplotlib.pyplot as plt` at the top"),
    ("mars2d.run(Scenario())", "write `import mars2d` at the top"),
    ("scenarios = Scenario()", "needs `scenario = Scenario(...)`"),
    ("scenario = 3", "or a function of one"),
    ("def scenario(n): return Scenario(robots=n)", "give it a default, or set it with --set n=..."),
    ("scenario = Scenario(robots=2 stop_time=3)", "line 7: invalid syntax"),
    ("scenario = Scenario(robots=2", "line 7: '(' was never closed"),
    ("def controll(world): return 0, 0", "must be called control: rename controll(world)"),
    ("def update(world): return 0, 0", "must be called control: rename update(world)"),
    ("def control(robot): return 0, 0", "line 7: control = control(robot): it is called "),
    ("def go(world): return 0, 0\nred = Robot(controller=go)", "it is called with a robot"),
    ("def go(robot): return 0, 0\nred = Robot(controller=go())",
     "argument: 'robot'; a law is given without brackets: go"),
    ("def go(robot=0): return 0, 0\nred = Robot(controller=go())", "without brackets ()"),
    ("def go(v, robot): return v, 0\nred = Robot(controller=go(1))", "functools.partial(go, 1)"),
    ("def go(robot): return 0, 0\nred = Robot(controller='go')", "without quotes"),
    ("class Go:\n    def __call__(self, robot): return 0, 0\nred = Robot(controller=Go)",
     "write Go(...)"),
    ("class Lamps(Addon):\n    def on_end(self, world): pass", "write on_stop(self, world)"),
    ("class Lamps(Addon):\n    def step(self, world): pass", "is never called; write on_step("),
    ("class Lamps(Addon):\n    def __init__(self, n): pass", "is not called: its fields stand"),
    ("open('way.csv')", "relative names begin in the current folder, /"),
    ("def go(robot): return 0, 0", "give go(robot) to a robot: Robot(controller=go)"),
]  # fmt: skip
"""Lines of an experiment's file."""

LAWS = [
    ("v = 1", "go returned nothing: a law returns its command, such as `return v, omega`"),
    ("return 1", "expected two numbers, (v, omega)"),
    ("return np.nan, 0", "a command must be finite"),
    ("robot.v = 0.2", "as `return v, omega`; keep things in robot.memory.v"),
    ("robot.pose[2] = 0", "a law can't change the world: it returns its command"),
    ("robot.pose = (0, 0, 0)", "a robot's pose can't be set"),
    ("robot.command = (1, 0)", "a robot's command can't be set"),
    ("return robot.x, 0", "write robot.pose[0]"),
    ("return robot.position[2], 0", "a position is (x, y); the angle is pose[2]"),
    ("return robot.pose[3], 0", "or pose[0] to pose[2]"),
    ("x, y = robot.pose\nreturn x, y", "a pose is three numbers: x, y, theta = robot.pose"),
    ("return robot.pose(), 0", "write it without the brackets: robot.pose"),
    ("return robot.pose.x, 0", "a pose is three numbers: x, y, theta = robot.pose"),
    ("return robot.proximity, 0", "did you mean 'sense.proximity'?"),
    ("return robot.props, 0", "write robot.world, which has them"),
    ("import math\nreturn math.sin(robot.pose), 0", "write np.cos in place of math.cos"),
    ("return robot.pose.min < 0, 0", "it is called with brackets"),
    ("return robot.speed, 0", "write robot.velocity: x', y' [m/s], theta' [rad/s]"),
    ("return robot.sense('proximity'), 0", "write robot.sense.proximity"),
    ("return robot.sense['proximity'], 0", "write robot.sense.proximity"),
    ("return robot.sense.lidar, 0", "red has no sensor 'lidar'; known: ground, proximity"),
    ("if robot.contacts: return 0, 0\nreturn 1, 0", "write len(robot.contacts) > 0"),
    ("if robot.sense.ground < 0.5:\n    return 0, 0\nreturn 1, 0",
     "compare one of them, as robot.sense.ground[0] < 0.5"),
    ("if robot.pose[:2] == (2, 0): return 0, 0\nreturn 1, 0",
     "np.linalg.norm(np.subtract(robot.pose[:2], (2, 0))) < 0.01"),
    ("return robot.world.robots[2].pose[0], 0",
     "there are robot.world.robots[0] to robot.world.robots[0]"),
    ("return (robot.world\n    .robots[3]\n    .pose[0]), 0", "to robot.world.robots[0]"),
    ("return robot.world.pose[0, 5], 0", "the last one is robot.world.pose[2, 0]"),
    ("return robot.world.robots['red'].pose[0], 0", "robot.world.robots[0]: red"),
    ("if robot.pose != (2, 0, 0): return 0, 0\nreturn 1, 0", "np.subtract(robot.pose, (2, 0, 0))"),
    ("return robot.neighbours[0].pose[0], 0", "robot.neighbours is empty"),
    ("return 0.2, 90 - robot.pose[2]", "if degrees are meant, write np.radians(88.5)"),
    ("return 3 - robot.pose[0], 2 - robot.pose[1]", "v [m/s] from -0.5 to 0.5 and omega"),
    ("if robot.sense.proximity < 0.5: return 0, 0\nreturn 1, 0",
     "line 9: robot.sense.proximity is True or False, and is compared with a number"),
    ("near = robot.sense.proximity\nif near > 1: return 0, 0\nreturn 1, 0",
     "line 10: robot.sense.proximity is True or False"),
    ("return robot.neighbors, 0", "did you mean 'neighbours'?"),
    ("return robot.memory['a'], 0", "write robot.memory.a"),
    ("robot.memory['a'] = 1", "write robot.memory.a"),
    ("robot.memory.n += 1", "robot.memory has no 'n' yet: set it first"),
    ("integral += 1", "keep it in robot.memory.integral"),
    ("return robot.dt, 0", "write robot.sampling_time"),
    ("return robot.goal[0], 0", "robot.memory"),
    ("robot.stop()", "write return v, omega: a law returns its command"),
    ("robot.drive(1, 0)", "a law returns its command, such as `return v, omega`"),
    ("return sinus(1), 0", "line 9: go raised NameError: name 'sinus' is not defined"),
    ("return random.random(), 0", "write `import random` at the top"),
    ("return 0, 45", "if degrees are meant, write np.radians(45)"),
    ("return 9, 0", "of the commands of red were cut by the drive's bounds"),
]  # fmt: skip
"""Bodies of a robot's law."""

FILES_OF_SCENARIOS = [
    ("diameter = 0,3", "line 4, robots[1]", "decimals have a point: 0.5"),
    ("pose = [0,5, 0,5, 0]", "line 4, robots[1]", "decimals have a point: 0.5"),
    ("pose = [0, 0, pi/2]", "line 4, robots[1]", "pi/2 is 1.57079633"),
    ("diameter = 2*0.15", "line 4, robots[1]", "TOML does not calculate"),
    ("pose = [0, 0, 90 deg]", "line 4, robots[1]", "90 degrees are 1.5708"),
    ("pose = [0, 0, 90\u00b0]", "line 4, robots[1]", "90 degrees are 1.5708"),
    ("pose = (0, 0, 0)", "line 4, robots[1]", "a list has brackets and commas: [1, 2]"),
    ("pose = 0, 0, 0", "line 4, robots[1]", "a list has brackets and commas: [1, 2]"),
    ("pose = [0 0 0]", "line 4, robots[1]", "a list has brackets and commas: [1, 2]"),
    ("pose = [0, 0,\n 1", "line 4", "Unclosed array"),
    ("diameter = 0.3 m", "line 4, robots[1]", "numbers have no units"),
    ("diameter = 5.", "line 4, robots[1]", "a digit stands behind the point: 5.0"),
    ("diameter = 0.3;", "line 4, robots[1]", "nothing stands between lines"),
    ("color = \u201cred\u201d", "line 4, robots[1]", "quotes are straight: 'red'"),
    ('color = "red', "line 4, robots[1]", "a text has a quote at both ends"),
    ("drive = { type: 'Car' }", "line 4, robots[1]", "a field is NAME = VALUE"),
    ("drive = { type = 'Car', }", "line 4, robots[1]", "no comma stands before }"),
    ("[robots]", "line 4, robots[1]", "a list of tables has double brackets, [[robots]]"),
    ("[[robot]]", "line 4", "did you mean 'robots'?"),
    ("stop_time = 3", "line 4, robots[1]", "fields of the scenario stand above the first table"),
    ("controller = 'law.py:wolk'", "line 4, robots[1]", "law.py: has no law 'wolk'; did you mean"),
    ("color = null", "line 4, robots[1]", "what is None is left out, or is 'none'"),
    ("color = red", "line 4, robots[1]", "text stands in quotes: 'red'"),
    ("color: 'red'", "line 4, robots[1]", "a field is NAME = VALUE"),
    ("diameter = .5", "line 4, robots[1]", "a digit stands before the point: 0.5"),
    ("// the leader", "line 4, robots[1]", "a comment begins with #"),
    ("[robots.drive]\nforce_limited = True", "line 5, robots[1].drive", "true and false"),
    ("drive = { type = 'Car',\n  wheelbase = 0.2 }", "line 4, robots[1]",
     "a table in braces has one line; a longer one has a head, [robots.drive]"),
]  # fmt: skip
"""Fields in files of TOML, as other languages write them."""

TEAMS = [
    ("return [[1, 2], [3]]", "its rows have 2 and 1 numbers"),
    ("return [(1, 0), (1, 0), (1, 0)]", "expected two rows and a column for each robot, shape (2"),
    ("return 1, 0", "expected two rows and a column for each robot, shape (2, 3)"),
    ("world.pose[0] = 1", "a law can't change the world"),
    ("return world.robot[0]", "did you mean 'robots'?"),
    ("return world.sense", "write world.robots[0], which has it"),
    ("integral += 1", "a function that assigns 'integral' has its own"),
]
"""Bodies of a team's law."""

COMMANDS = [
    ("walk.py", "write mars2d run walk.py"),
    ("runn walk.py", "did you mean 'run'?"),
    ("nothing", "there is no command 'nothing'; known: "),
    ("run wolk.py", "did you mean 'walk.py'?"),
    ("run nothing", "mars2d list shows the examples"),
    ("run walk.py --headles", "did you mean '--headless'?"),
    ("run walk.py --headless --time 1", "write --stop-time S"),
    ("run walk.py --headless --seeds 3", "write --seed K; mars2d sweep has --seeds N"),
    ("run walk.py --headless --record a.txt", "expected a name that ends in .npz"),
    ("run walk.py --headless --figure a.gif", "expected a name that ends in .png"),
    ("run walk.py --headless --set robots.*.drive=Holonomic()", "write Holonomic() in the file"),
    ("run walk.py --headless --set robots.rde.mass=3", "did you mean 'red'?"),
    ("run walk.py --headless --set stop_tme=3", "did you mean 'stop_time'?"),
    ("run walk.py --headless --set stop_time:3", "expected NAME=VALUE"),
    ("run walk.py --headless --speed fast", "expected a number >= 0, or max"),
    ("sweep walk.py --set stop_time=1,2 --measure foo", "there is no measure 'foo'; known: "),
    ("plot walk.py paths", "run it first: mars2d run walk.py --record walk.npz"),
    ("replay walk.py", "expected a record"),
]
"""Command lines."""


@pytest.fixture
def answer(tmp_path, monkeypatch, capsys):
    """Return a function that runs a command line in an empty folder and returns its stderr."""
    monkeypatch.chdir(tmp_path)

    def run(text, *words):
        (tmp_path / "walk.py").write_text(text)
        main([*words] or ["run", "walk.py", "--headless"])
        out, err = capsys.readouterr()
        return err + "".join(f"{line}\n" for line in out.splitlines() if line.startswith("note: "))

    return run


def indented(lines):
    return "".join(f"    {line}\n" for line in lines.split("\n"))


def helps(told, words):
    """Check that an answer has some words, and no nonsense."""
    assert any(each in told for each in words.split("|")), told
    assert "did you mean 'None'" not in told
    assert "Traceback" not in told
    assert len(told.splitlines()) <= 2, told
    line = re.search(r"walk\.py, line (\d+)", told)
    assert line is None or int(line[1]) > 0


@each_case("fields, words", ROBOTS)
def test_a_robots_field(answer, fields, words):
    told = answer(f"{HEAD}scenario = Scenario(robots=[Robot({fields})], stop_time=0.3)\n")
    helps(told, words)
    assert "walk.py, line 7" in told


@each_case("fields, words", SCENARIOS)
def test_a_scenarios_field(answer, fields, words):
    told = answer(f"{HEAD}scenario = Scenario({fields}, stop_time=0.3)\n")
    helps(told, words)
    assert "walk.py, line 7" in told


@each_case("lines, words", FILES)
def test_a_line_of_a_file(answer, lines, words):
    end = "" if "scenario" in lines else "\nscenario = Scenario(stop_time=0.3)\n"
    helps(answer(HEAD + lines + end), words)


@each_case("body, words", LAWS)
def test_a_law_of_a_robot(answer, body, words):
    made = "Robot(name='red', controller=go, sensors=[Proximity(range=1), Ground()])"
    told = answer(
        f"{HEAD.rstrip()}\nintegral = 0\n\ndef go(robot):\n{indented(body)}\n"
        f"scenario = Scenario(robots=[{made}], stop_time=0.3)\n"
    )
    helps(told, words)
    assert "red" in told or "walk.py, line " in told


@each_case("body, words", TEAMS)
def test_a_law_of_a_team(answer, body, words):
    told = answer(
        f"{HEAD}integral = 0\ndef control(world):\n{indented(body)}\n"
        "scenario = Scenario(robots=3, stop_time=0.3)\n"
    )
    helps(told, words)
    assert "walk.py, line " in told
    assert "(at 0 s)" in told


def test_two_robots_commands_are_not_taken_for_rows(answer):
    for pairs in ("[(0.2, 0.1), (0.2, 0.1)]", "(0.2, 0.1), (0.2, 0.1)"):
        told = answer(f"{HEAD}scenario = Scenario(robots=2)\ndef control(world): return {pairs}\n")
        helps(told, "is each tuple a robot's command? Then write np.transpose(...) of them")
    rows = "    rows = []\n    for robot in world.robots: rows.append([0.3, 0.1])\n    return rows"
    items = rows.replace("[]", "np.zeros((2, 2))").replace("rows.append([0.3, 0.1])", "pass")
    items = items.removesuffix("\n    return rows")
    items += "\n    for i in range(2):\n        rows[i] = 0.3, 0.1\n    return np.array(rows)"
    for body, line in ((rows, 10), (items, 12), (rows + ".T", 0), (items[:-5] + "rows.T)", 0)):
        law = f"class Team:\n  def __call__(self, world):\n{body}\ncontrol = Team()\n"
        told = answer(f"{HEAD}{law}scenario = Scenario(robots=2, stop_time=0.3)\n")
        assert ("this is a row for each robot" in told) is (line > 0), told
        assert not line or f"walk.py, line {line}: " in told


@each_case("lines, place, words", FILES_OF_SCENARIOS)
def test_a_scenario_file(answer, lines, place, words):
    Path("law.py").write_text("def walk(robot): return 0, 0\n")
    Path("room.toml").write_text(f"format = 1\n[[robots]]\n[[robots]]\n{lines}\n")
    told = answer("", "run", "room.toml", "--headless")
    helps(told, words)
    assert told.startswith(f"mars2d: room.toml, {place}: ")


@each_case(
    "act, words",
    [
        (lambda record: record.sensors["sonar"], "the record has no sensor 'sonar'; known: front"),
        (lambda record: record.sensors["frnt"], "did you mean 'front'?"),
        (lambda record: record.sensors.front, "write record.sensors['front']"),
        (lambda record: record.sensor_robots["sonar"], "the record has no sensor 'sonar'"),
        (lambda record: record.plot_signals(["x", "spee"]), "did you mean 'speed'?"),
        (lambda record: mars2d.load("way.npz"), "there is no such file in the current folder, /"),
    ],
)
def test_a_line_about_a_record(act, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    robot = mars2d.Robot(sensors=[Proximity(range=1, name="front")])
    record = mars2d.run(mars2d.Scenario(robots=[robot], stop_time=0.3))
    assert [ax.get_ylabel() for ax in record.plot_signals(["x", "y"])] == ["x [m]", "y [m]"]
    with pytest.raises(InputError) as caught:
        act(record)
    assert words in str(caught.value)


def test_a_robot_and_a_world_are_printed_with_what_they_see():
    printed = []

    def look(robot):
        printed.append(str(robot))
        return 0.0, 0.0

    sensors = [Proximity(range=1)]
    robots = [
        mars2d.Robot(name=sees, pose=(k, 1, 0), controller=look, sees=sees, sensors=sensors)
        for k, sees in enumerate(("full", "sensors"))
    ]
    world = mars2d.World(mars2d.Scenario(robots=robots, stop_time=1))
    world.step()
    assert printed == [
        "<robot 'full' at (0, 1, 0), proximity = True>",
        "<robot 'sensors', proximity = True>",
    ]
    text = str(world).splitlines()
    assert text[:2] == ["<World at 0.1 s:", "  <robot 'full' at (0, 1, 0), proximity = True>"]
    assert isinstance(world.robots[0], mars2d.RobotView)
    assert isinstance(world, mars2d.WorldView)


def test_bodies_that_go_through_each_other_may_overlap_at_the_start():
    robots = [mars2d.Robot(), mars2d.Robot(pose=(0.1, 0, 0))]
    assert mars2d.run(mars2d.Scenario(robots=robots, physics="ideal", stop_time=0.3)).finished


def test_a_missing_library_may_be_caught_as_an_import_that_failed():
    with (
        pytest.raises(ImportError, match="tables need nothing: pip install"),
        extra("rl", "tables need nothing"),
    ):
        import no_such_library  # noqa: F401


@each_case("line, words", COMMANDS)
def test_a_command_line(answer, line, words):
    text = f"{HEAD}scenario = Scenario(robots=[Robot(name='red')], stop_time=0.3)\n"
    told = answer(text, *line.split())
    helps(told, words)
    assert told.startswith("mars2d: ")
