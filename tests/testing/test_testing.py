"""The checkers of a user's own parts: each fault is seen and named, and what is sound passes."""

# ruff: noqa: PLW0603, SIM105 - faults, as people write them

from __future__ import annotations

import random
import textwrap
import time

import numpy as np
import pytest

from mars2d import Addon, Robot, Scenario, Sensor, sensors
from mars2d.addons import Map
from mars2d.cli import command_line as cli
from mars2d.core.deadline import Deadline
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment, open_module
from mars2d.scenario.registry import members
from mars2d.sensors import ANGLE, DISTANCE
from mars2d.testing import (
    CheckError,
    check_addon,
    check_controller,
    check_sensor,
)
from mars2d.testing.file import trials
from tests.cases import each_case


def findings_of(check, part, **options):
    """All that a checker finds."""
    try:
        check(part, **options)
    except CheckError as error:
        return error.findings
    return ()


def texts(findings) -> list[str]:
    return [finding.text for finding in findings]


def seen(findings, *words: str) -> bool:
    """Whether one of the findings has all these words."""
    return any(all(word in text for word in words) for text in texts(findings))


# -- sensors ----------------------------------------------------------------------------------


def sensor(read=None, **body):
    """A sensor whose class has these methods and attributes."""
    body = {"__doc__": "A sensor.", **body} | ({"read": read} if read else {})
    return type("Probe", (Sensor,), body)()


def by_time(first, second):
    return lambda self, robot, world, rng: first if world.time < 0.15 else second


def value(result):
    return lambda self, robot, world, rng: result


SHARED: list[float] = []


def remembers(self, robot, world, rng):
    SHARED.append(1.0)
    return float(len(SHARED))


def fails_late(self, robot, world, rng):
    return 1.0 / (world.time < 1.05)


def clock(self, robot, world, rng):
    return time.perf_counter()


SENSORS = {
    "read is missing": (sensor, ["no method read", "read(self, robot, world, rng)"]),
    "arguments are in another order": (
        lambda: sensor(lambda self, world, robot, rng: 1.0),
        ["(self, world, robot, rng)", "in this order"],
    ),
    "the shape changes": (
        lambda: sensor(by_time(np.zeros(3), np.zeros(2))),
        ["it was numbers of shape (3,), now it is numbers of shape (2,)", "at 0.2 s"],
    ),
    "it raises": (
        lambda: sensor(fails_late),
        ["test_testing.py, line", "Probe.read raised ZeroDivisionError", "at 1.1 s"],
    ),
    "a distance is nan": (
        lambda: sensor(value(np.nan), quantities=(DISTANCE,)), ["nan of distance", "inf to"],
    ),
    "a distance is negative": (
        lambda: sensor(value(-0.1), quantities=(DISTANCE,)), ["-0.1 of distance", "not negative"],
    ),
    "a distance is beyond the range": (
        lambda: sensor(value(2.0), quantities=(DISTANCE,), range=1.0), ["beyond the range, 1 m"],
    ),
    "an angle is not wrapped": (
        lambda: sensor(value(4.0), quantities=(ANGLE,)), ["4 of angle [rad]", "(-pi, pi]", "wrap"],
    ),
    "Python's shared generator": (
        lambda: sensor(lambda self, robot, world, rng: random.random()),
        ["Probe draws from random", "draw from rng"],
    ),
    "a clock": (lambda: sensor(clock), ["not repeatable", "a clock"]),
    "something is kept in the file": (
        lambda: sensor(remembers), ["not repeatable", "a variable of the file"],
    ),
}  # fmt: skip


# -- add-ons ----------------------------------------------------------------------------------


def addon(**body):
    return type("Judge", (Addon,), {"__doc__": "An add-on.", **body})()


def told(self, world):
    SHARED.append(1.0)
    self.score = len(SHARED)


ADDONS = {
    "a hook takes too little": (
        lambda: addon(on_step=lambda self: None), ["Judge.on_step", "on_step(self, world)"],
    ),
    "on_step raises": (
        lambda: addon(on_step=lambda self, world: self.score),
        ["test_testing.py, line", "add-on 'judge' raised AttributeError"],
    ),
    "something is kept in the file": (
        lambda: addon(on_step=told), ["Judge is not repeatable", "add-on judge.score"],
    ),
}  # fmt: skip


def test_a_map_of_another_place_is_tried_where_its_walls_leave_room():
    check_addon(Map([[(-9, -9), (9, 9)], [(-9, 9), (9, -9)]]))


# -- laws -------------------------------------------------------------------------------------


def wander(robot):
    return 0.3, robot.rng.uniform(-1, 1)


def patrol(robot):
    while True:
        for _ in range(5):
            yield 0.3, 0.0
        yield 0.0, 1.0


def gather(world):
    return np.vstack([0.1 * np.ones(3), world.rng.uniform(-1, 1, 3)])


@each_case("law", [wander, patrol, gather])
def test_sound_laws_pass_without_a_finding(law):
    check_controller(law)
    assert findings_of(check_controller, law) == ()


calls = 0


def counting(robot):
    global calls
    calls += 1
    return 0.1, 0.001 * calls


class Pilot:
    """A law that is an object, with one memory for all robots of all worlds."""

    count = 0

    def __call__(self, robot):
        self.count += 1
        return 0.1, 0.001 * self.count


def hurt_late(robot):
    for _ in range(5):
        yield 0.1, 0.0
    raise KeyError("lost")


LAWS = {
    "two arguments": (lambda robot, world: (0, 0), {}, ["exactly one argument, the robot"]),
    "nothing is returned": (lambda robot: None, {}, ["returned nothing", "return v, omega"]),
    "a generator fails": (hurt_late, {}, ["hurt_late raised KeyError: 'lost'", "at 0.5 s"]),
    "Python's shared generator, of the team": (
        lambda world: np.full((2, 3), random.random()), {}, ["draws from random", "world.rng"],
    ),
    "a global variable": (
        counting, {}, ["counting is not repeatable", "a variable of the file", "robot.memory"],
    ),
    "attributes of an object": (Pilot(), {}, ["Pilot is not repeatable"]),
    "it sees sensors only": (
        lambda robot: (robot.pose[0], 0), {"sees": "sensors"}, ["robot.pose is not available"],
    ),
    "a sensor is missing": (
        lambda robot: (robot.sense.whisker, 0), {}, ["has no sensor 'whisker'"],
    ),
}  # fmt: skip


FAULTS = [
    *((name, check_sensor, make(), {}, words) for name, (make, words) in SENSORS.items()),
    *((name, check_addon, make(), {}, words) for name, (make, words) in ADDONS.items()),
    *((name, check_controller, *law) for name, law in LAWS.items()),
]


@each_case(("fault", "check", "part", "options", "words"), FAULTS)
def test_a_fault_is_named(fault, check, part, options, words):
    SHARED.clear()
    findings = findings_of(check, part, **options)
    assert seen(findings, *words), texts(findings)


def test_a_law_is_tried_on_the_robots_of_a_scenario_that_have_it():
    def unlucky(robot):
        return 0.1, random.random()

    robots = [Robot(controller=wander), Robot(pose=(1, 0, 0), controller=unlucky)]
    scenario = Scenario(robots=robots)
    assert findings_of(check_controller, wander, scenario=scenario) == ()
    assert seen(findings_of(check_controller, unlucky, scenario=scenario), "random")


def test_what_differs_only_beside_a_second_world_is_named():
    class Shared(Sensor):
        now = {}

        def on_start(self, robot, world, rng):
            Shared.now[robot.index] = 0.0

        def on_step(self, robot, world, rng):
            Shared.now[robot.index] += world.pose[0, robot.index]

        def read(self, robot, world, rng):
            return Shared.now[robot.index]

    assert seen(findings_of(check_sensor, Shared()), "not repeatable", "beside a second world")


# -- what never ends --------------------------------------------------------------------------


def spin(*_):
    while True:
        try:
            time.sleep(0)
        except Exception:
            pass


def spin_for_ever(robot):
    return spin()


def test_the_line_that_does_not_end_is_named():
    found = findings_of(check_controller, spin_for_ever, deadline=Deadline(0.3))
    assert seen(found, "test_testing.py, line", "spin_for_ever did not come to an end")


# -- what belongs to MARS2D -------------------------------------------------------------------


SENSORS_NEED = {"Proximity": {"range": 1.0}}
ADDONS_NEED = {
    "Beacon": {"at": (1.0, 1.0)},
    "Density": {"function": lambda x, y: 1 + x * x},
    "Game": {"roles": {"hunter": ["robot0"], "hunted": ["robot1"]}},
    "Map": {"outlines": [[(0, 1.6), (0.3, 1.6)]]},
    "Ring": {"roles": {"red": ["robot0"], "blue": ["robot1"]}},
    "Theory": {"draws": lambda scene, frame: scene.circle((0, 0), 1.0, stroke="#7b3294")},
    "Waypoints": {"routes": [[(1.0, 0.0)]]},
}
"""What parts of MARS2D's own need."""


@pytest.mark.slow
@each_case("name", sorted(members("sensors")))
def test_the_sensors_of_mars2d_are_sound(name):
    check_sensor(members("sensors")[name](**SENSORS_NEED.get(name, {})))


@pytest.mark.slow
@each_case("name", sorted(members("addons")))
def test_the_addons_of_mars2d_are_sound(name):
    addon = members("addons")[name](**ADDONS_NEED.get(name, {}))
    check_addon(addon, sensors=[sensors.Odometry(), sensors.Proximity(range=1.0)])


@pytest.mark.slow
@pytest.mark.nightly
@each_case("name", sorted(examples()))
def test_the_parts_and_laws_of_the_examples_are_sound(name):
    module = open_module(examples()[name])
    tried = list(trials(module, open_experiment(module)))
    wrong = [(t.name, text) for t in tried for text in texts(t.findings())]
    assert wrong == []


# -- the command ------------------------------------------------------------------------------

HEAD = """
import random, time
from mars2d import Addon, Drive, Robot, Scenario, Sensor
from mars2d.core.description import number
"""

GOOD = """
class Clock(Sensor):
    def read(self, robot, world, rng):
        return world.time

class Judge(Addon):
    def on_step(self, world):
        self.now = world.time

def control(robot):
    return 0.1, 0.01 * robot.sense.clock
"""


def checked(tmp_path, capsys, code: str) -> tuple[int, str, str]:
    """The exit code of `mars2d check`, and what it prints, of a file with this code."""
    path = tmp_path / "own.py"
    path.write_text(HEAD + textwrap.dedent(code), encoding="utf-8")
    result = cli.main(["check", str(path)])
    printed = capsys.readouterr()
    return result, printed.out, printed.err


@each_case(
    ("method", "does", "words"),
    [
        ("draw(self, scene, frame)", "self.drawn = frame.time", "Halo.draw raised Frozen"),
        ("paint(self, scene, area)", "scene.polygon(area[9])", "Halo.paint raised IndexError"),
        ("paint(self, scene)", "pass", "Halo.paint has the arguments (self, scene)"),
    ],
)
def test_what_an_add_on_draws_is_tried(tmp_path, capsys, method, does, words):
    source = f"class Halo(Addon):\n    def {method}:\n        {does}\n"
    code, out, err = checked(tmp_path, capsys, source)
    assert code == 2
    assert words in out + err


def test_parts_are_tried_in_the_files_own_scenario(tmp_path, capsys):
    use = "scenario = Scenario(robots=[Robot(sensors=[Clock()], controller=steer)])"
    code, out, err = checked(tmp_path, capsys, GOOD.replace("control", "steer") + use)
    assert (code, err) == (0, "")
    assert "sensor Clock in its scenario: sound" in out
    assert "add-on Judge in a small world: sound" in out
    assert "law steer of robot0: sound" in out
    assert out.endswith("sound: 11 control steps done\n")


def test_what_is_wrong_is_listed_and_the_exit_code_is_2(tmp_path, capsys):
    bad = """
    class Noise(Sensor):
        def read(self, robot, world, rng):
            return random.random() - 0.5

    class Judge(Addon):
        def on_draw(self, world, scene):
            world.nothing
    """
    code, out, err = checked(tmp_path, capsys, bad)
    assert code == 2
    assert err.endswith("own.py: 2 things are wrong, as said above\n")
    assert err.count("\n") == 1
    lines = out.splitlines()
    assert lines[0] == "sensor Noise in a small world: 1 thing wrong"
    assert lines[1].startswith("  wrong Noise draws from random")
    assert lines[2] == "add-on Judge in a small world: 1 thing wrong"


def test_a_part_with_required_fields_is_tried_as_the_scenario_has_it(tmp_path, capsys):
    sonar = """
    class Sonar(Sensor):
        reach: float = number(above=0, unit="m")

        def read(self, robot, world, rng):
            return self.reach
    """
    use = textwrap.dedent(sonar) + "robots = [Robot(sensors=[Sonar(reach=1.0)])]\n"
    code, out, _ = checked(tmp_path, capsys, use + "scenario = Scenario(robots=robots)\n")
    assert code == 0
    assert "sensor Sonar in its scenario: sound" in out
    code, out, _ = checked(tmp_path, capsys, use + "scenario = Scenario()\n")
    assert "not tried, since no object is in a scenario: Sonar.reach" in out


def test_a_fault_is_counted_once_and_no_innocent_law_is_blamed(tmp_path, capsys):
    both = """
    class Broken(Addon):
        def on_step(self, world):
            raise OSError("no device")

    def steer(robot):
        return 0.1, 0.0

    def control(world):
        return 0.1, 0.0

    robots = [Robot(controller=steer), Robot(pose=(1, 1, 0))]
    scenario = Scenario(robots=robots, addons=[Broken()])
    """
    code, out, err = checked(tmp_path, capsys, both)
    assert code == 2
    assert "add-on Broken in its scenario: 1 thing wrong" in out
    assert out.count("  wrong ") == 1
    for law in ("law steer of robot0", "law control of the team"):
        assert f"{law}: not tried to the end, 1 hint" in out
    assert "steer: its scenario does not run: own.py, line 8: add-on 'broken' raised" in out
    assert err == "mars2d: own.py, line 8: add-on 'broken' raised OSError: no device (at 0 s)\n"


READERS = {
    "add-on": "class Own(Addon):\n    def on_step(self, world):\n        "
    "self.near = world.robots[0].sense.range_finder\n",
    "law": "def control(robot):\n    return robot.sense.range_finder[0], 0.0\n",
}


@each_case("family", READERS)
def test_robots_without_the_sensor_that_is_read_are_no_fault_of_a_part(tmp_path, capsys, family):
    code, out, err = checked(tmp_path, capsys, READERS[family])
    assert (code, err) == (0, "")
    assert "in a small world: not tried to the end, 1 hint" in out
    assert "no sensor 'range_finder'" in out
    assert "give a scenario whose robots do" in out


@pytest.mark.slow
def test_a_check_ends_whatever_the_file_does(child, tmp_path):
    (tmp_path / "own.py").write_text(HEAD + "while True:\n    pass\n", encoding="utf-8")
    code = (
        "import sys; from mars2d.core import deadline; from mars2d.cli.verbs import check;"
        "deadline.GRACE = 0.5; check.LOADING = 0.5; check.PATIENCE = 0.5;"
        "from mars2d.cli.command_line import main;"
        f"sys.exit(main(['check', {str(tmp_path / 'own.py')!r}]))"
    )
    done = child(code)
    assert done.returncode == 2, done.stderr
    assert "come to an end" in done.stderr
    assert "own.py, line 5" in done.stderr
    assert "Traceback" not in done.stderr
