"""Parameters: which numbers can be set, within which bounds, and by which names."""

from __future__ import annotations

import pytest

from mars2d import InputError, Robot, Scenario, load, run
from mars2d.bodies import Box
from mars2d.scenario.changes import alike
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.options import options_in_words
from mars2d.scenario.parameters import Parameter, arguments_of
from tests.cases import each_case

FILE = """
from functools import partial
from typing import Annotated
from mars2d import Range, Robot, Scenario

def go(speed: Annotated[float, Range(0, 1, unit="m/s")], turn, robot, wobble=0.1):
    return speed, turn + wobble

def scenario(
    mu: Annotated[float, Range(0.5, 1.5)] = 0.9,
    robots: Annotated[int, Range(1, 5)] = 2,
    gap: float = 1.0,
    quick=3,
    loud: bool = False,
    path: str = "a",
):
    one = Robot(mass=mu, controller=partial(go, 0.3, 0.2))
    return Scenario(robots=[one.at(0, gap * k) for k in range(robots)])

def control(world, gain=0.5):
    return [[gain] * len(world.robots), [0.0] * len(world.robots)]
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "file.py"
    path.write_text(FILE)
    return path


def names(experiment):
    return {each.name: each for each in experiment.parameters()}


def test_a_file_has_the_numbers_of_its_function_then_those_of_its_laws(file):
    found = names(open_experiment(file))
    assert [*found] == [
        "mu", "robots", "gap", "quick",
        "laws.control.gain", "laws.go.speed", "laws.go.wobble", "laws.go.turn",
    ]  # fmt: skip
    assert found["mu"] == Parameter("mu", 0.9, 0.9, 0.5, 1.5)
    assert found["robots"] == Parameter("robots", 2, 2, 1, 5, whole=True)
    assert found["laws.go.speed"] == Parameter("laws.go.speed", 0.3, 0.3, 0, 1, "m/s")


def test_without_a_range_the_bounds_are_a_guess(file):
    found = names(open_experiment(file))
    assert (found["gap"].low, found["gap"].high) == (0.0, 2.0)
    assert (found["quick"].low, found["quick"].high, found["quick"].whole) == (0, 10, True)
    nothing = Parameter.of("x", 0.0, arguments_of(lambda x=0.0: x)["x"], 0.0)
    assert (nothing.low, nothing.high) == (-1.0, 1.0)
    below = Parameter.of("x", -3.0, arguments_of(lambda x=-2.0: x)["x"], -2.0)
    assert (below.low, below.high) == (-4.0, 0.0)
    far = open_experiment(file, {"gap": 4.0})
    assert names(far)["gap"] == Parameter("gap", 4.0, 1.0, 0.0, 4.0)


def test_values_step_by_a_power_of_ten(file):
    found = names(open_experiment(file))
    assert found["mu"].step == 0.01
    assert found["mu"].nearest(0.30000001) == 0.5
    assert found["mu"].nearest(0.8149) == 0.81
    assert found["robots"].nearest(3.4) == 3
    odd = Parameter("x", 0.2, 0.2, 0.123, 0.456)
    assert odd.nearest(0.0) == 0.123, "its own ends can be reached"


@each_case(
    ("options", "words"),
    [
        ({"mu": 2}, r"scenario\(mu\) = 2: expected a number >= 0.5 and <= 1.5, as its Range says"),
        ({"mu": "x"}, r"scenario\(mu\) = 'x': expected a number; its default is 0.9"),
        ({"laws.go.speed": 3}, r"laws.go.speed = 3: expected a number >= 0 and <= 1 \[m/s\]"),
        ({"laws.go.sped": 1}, "no option 'laws.go.sped'; did you mean 'laws.go.speed'"),
        ({"laws.went.speed": 1}, "no option 'laws.went.speed'"),
        ({"robots": 9}, r"scenario\(robots\) = 9: expected a number >= 1 and <= 5"),
    ],
)
def test_what_no_range_allows_is_refused_by_name(file, options, words):
    with pytest.raises(InputError, match=words) as raised:
        open_experiment(file, options)
    assert raised.value.where == "file.py"


@each_case(
    ("line", "words"),
    [
        ("mu: Annotated[float, Range(0, 1)] = 2.0", r"the default of scenario\(mu\) = 2.0: exp"),
        ("mu: 'Annotated[float, Range(0, q)]' = 2.0", r"scenario\(mu\): its annotation can't be"),
        ("mu: Annotated[float, Range(1, 0)] = 2.0", r"Range.high = 0.0: expected a number > low"),
        ("mu: 'unknown' = 1.0, nu: Annotated[float, Range(0, 1)] = 3.0", r"default of .*\(nu\)"),
    ],
)
def test_a_range_that_can_not_be_is_an_error_of_the_file(tmp_path, line, words):
    path = tmp_path / "file.py"
    head = "from typing import Annotated\nfrom mars2d import Range, Scenario\n"
    path.write_text(f"{head}def scenario({line}):\n    return Scenario()\n")
    with pytest.raises(InputError, match=words):
        open_experiment(path)


def test_arguments_of_laws_are_set_where_they_stand_and_shared_as_before(file):
    experiment = open_experiment(file, {"laws.go.speed": 0.7, "laws.go.wobble": 0.0})
    one, other = (robot.controller for robot in experiment.scenario.robots)
    assert one is other
    assert one.args == (0.7, 0.2)
    assert one.keywords == {"wobble": 0.0}
    assert one(None) == (0.7, 0.2)
    found = names(experiment)
    assert (found["laws.go.speed"].value, found["laws.go.speed"].default) == (0.7, 0.3)
    assert (found["laws.go.wobble"].value, found["laws.go.wobble"].default) == (0.0, 0.1)
    again = experiment.with_options({"laws.control.gain": 2.0})
    assert again.scenario.robots[0].controller.args == (0.3, 0.2)
    assert again.control.keywords == {"gain": 2.0}


def test_the_seed_of_the_run_is_that_of_a_function_that_has_one():
    seed = names(open_experiment("corner_game", seed=4))["seed"]
    assert (seed.value, seed.default) == (4, 4)
    seed = names(open_experiment("corner_game", {"seed": 2}, seed=4))["seed"]
    assert (seed.value, seed.default) == (2, 4)


def test_a_body_has_mass_surface_and_bounds_of_its_drive():
    scenario = Scenario(robots=[Robot(name="a.b")], props=[Box(pose=(2, 0, 0), name="crate")])
    experiment = open_experiment(scenario, {"props.crate.mass": 3.0})
    found = {each.name: each for each in experiment.parameters(0)}
    assert [*found] == [
        "robots.0.mass", "robots.0.friction", "robots.0.restitution",
        "robots.0.drive.max_linear_speed", "robots.0.drive.max_force", "robots.0.drive.max_torque",
    ]  # fmt: skip
    assert found["robots.0.drive.max_force"].unit == "N"
    assert found["robots.0.restitution"].high == 1.0
    crate = {each.name: each for each in experiment.parameters(1)}
    assert "props.crate.ground_friction" in crate
    mass = crate["props.crate.mass"]
    assert (mass.value, mass.default, mass.unit) == (3.0, 1.0, "kg")
    assert 0 < mass.low < mass.high


def test_all_that_is_listed_can_be_set_to_its_value():
    for name in [*examples()][::3]:
        experiment = open_experiment(name)
        values = {each.name: each.value for each in experiment.parameters()}
        values |= {each.name: each.value for each in experiment.parameters(0)}
        again = experiment.with_options(values)
        assert {each.name: each.value for each in again.parameters()}.items() <= values.items()
        for each in again.parameters():
            assert each.low <= each.default <= each.high
            assert each.nearest(each.value) == pytest.approx(each.value, abs=each.step)


def test_a_drawn_scenario_takes_fields_and_laws_but_no_arguments_of_its_function(file):
    experiment = open_experiment(file, {"mu": 1.2})
    drawn = experiment.redrawn(experiment.scenario.replace(title="Drawn"))
    assert next(each.name for each in drawn.parameters()) == "laws.control.gain"
    options = {**drawn.options, "robots.robot0.mass": 2.0, "laws.go.speed": 0.9}
    again = drawn.with_options(options)
    assert again.scenario.title == "Drawn"
    assert [robot.mass for robot in again.scenario.robots] == [2.0, 1.2]
    assert again.scenario.robots[0].controller.args == (0.9, 0.2)
    assert again.parameters(0)[0].default == 1.2
    reopened = again.reopened()
    assert alike(reopened.scenario, again.scenario)
    assert reopened.scenario.robots[1].controller.args == (0.9, 0.2)
    assert again.with_options(drawn.options).scenario.robots[0].mass == 1.2


def test_a_record_keeps_the_options_that_its_experiment_was_opened_with(file, tmp_path):
    options = {"mu": 1.2, "laws.go.speed": 0.4, "stop_time": 1.0, "robots.1.pose": (1, 2, 0)}
    record = run(file, options=options)
    assert run(file, options=options).digest == record.digest
    for suffix in (".npz", ".mcap", ".csv"):
        record.save(tmp_path / f"run{suffix}")
        assert load(tmp_path / f"run{suffix}").options == options
    words = "mu = 1.2, laws.go.speed = 0.4, stop_time = 1.0, robots.1.pose = (1, 2, 0)"
    assert options_in_words(options) == words


def test_annotations_may_be_postponed(tmp_path):
    path = tmp_path / "later.py"
    path.write_text("from __future__ import annotations\n" + FILE)
    found = names(open_experiment(path))
    assert found["mu"] == Parameter("mu", 0.9, 0.9, 0.5, 1.5)
    assert found["laws.go.speed"].unit == "m/s"
