"""Starts at random: by `random_starts`, or by a scenario function with a parameter `seed`."""

from itertools import combinations

import numpy as np
import pytest
import shapely

import mars2d
from mars2d import InputError, RandomStarts, Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies import Bar, Box, Rope
from mars2d.cli import command_line as cli
from mars2d.core.plane import lines_and_areas
from mars2d.geometry import Disc, Polygon
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.starts import footprint
from mars2d.world.timeline import Timeline
from mars2d.world.verify import rerun
from tests.cases import each_case

FILE = """
from mars2d import Robot, Scenario
def law(robot):
    return 0.1, 0.0
def scenario(gap=1.0, seed=99):
    return Scenario(robots=[Robot(controller=law).at(0, gap * seed)], workspace=None, stop_time=0.2)
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "drawn.py"
    path.write_text(FILE)
    return path


def start(record):
    return float(record.pose[0, 1, 0])


def test_a_scenario_function_gets_the_seed_of_the_run(file):
    assert start(mars2d.run(file)) == 0.0
    record = mars2d.run(file, seed=3, options={"gap": 0.5})
    assert (start(record), record.seed) == (1.5, 3)
    assert start(mars2d.run(mars2d.scenario.experiment.open_module(file), seed=4)) == 4.0


def test_a_seed_that_can_not_be_is_refused_before_the_function_sees_it(file, capsys):
    file.write_text(
        FILE.replace("    return Scenario", "    assert False, seed\n    return Scenario")
    )
    for seed in (-1, 2**63, 1.5, "3"):
        with pytest.raises(InputError, match=r"^seed = .*: expected a whole number from 0"):
            mars2d.run(file, seed=seed)
    assert cli.main(["run", str(file), "--headless", "--seed", "-1"]) == cli.BAD_INPUT
    assert "seed = -1: expected a whole number" in capsys.readouterr().err


# -- declared -------------------------------------------------------------------------------------

TRIANGLE = [(-4, -4), (4, -4), (0, 4)]


def crowd(**changes):
    """Ten robots of three shapes among walls and a bar that stands; the crate is placed as well."""
    robots = [
        Robot(shape=shape, controller=law)
        for shape in [Disc(0.3), Polygon([(-0.2, -0.2), (0.6, 0), (-0.2, 0.2)]), Disc(0.1)] * 3
    ]
    fields = {
        "robots": [*robots, Robot(name="guest")],
        "props": [Box(name="crate", length=1.0), Bar(name="bar", pose=(0, -2, 0.5), length=3)],
        "addons": [Map([[(-3, 0), (2, 1)], [(1, 2), (2, 2), (2, 3)]])],
        "on_exit": "wall",
        "random_starts": [
            RandomStarts(["guest"], area=TRIANGLE, heading=1.5),
            RandomStarts([f"robot{i}" for i in range(9)], least_distance=1.25),
            RandomStarts(["crate"]),
        ],
        "stop_time": 0.5,
    }
    return Scenario(**(fields | changes))


def law(robot):
    return 0.1, 0.0


@each_case("seed", [0, 2**63 - 1])
def test_all_start_in_their_area_apart_and_clear_of_everything(seed):
    found = crowd().started(seed)
    found.replace()  # refuses starts that overlap, or that are in a wall
    x, y, heading = found.initial_pose
    assert shapely.Polygon(TRIANGLE).contains(shapely.Point(x[9], y[9]))
    assert heading[9] == 1.5
    apart = np.hypot(x[:9, None] - x[:9], y[:9, None] - y[:9])[np.triu_indices(9, 1)]
    assert apart.min() >= 1.25
    grounds = [footprint(body) for body in found.bodies]
    walls = shapely.union_all(
        [shapely.LinearRing(found.workspace), *lines_and_areas(found.obstacles)]
    )
    assert all(a.disjoint(b) for a, b in combinations(grounds, 2))
    assert all(ground.disjoint(walls) for ground in grounds)


def test_a_pose_follows_from_the_seed_alone():
    one, other = (World(crowd(), seed=seed) for seed in (1, 2))
    assert (one.pose != other.pose).all(axis=0)[:9].all()
    assert one.scenario.props[1].pose == other.scenario.props[1].pose == (0, -2, 0.5)
    other.reset(seed=1)
    assert (one.pose == other.pose).all()
    assert one.scenario == crowd().started(1) == crowd().started(1).started(5)
    assert not one.scenario.random_starts


def test_places_are_spread_evenly_over_their_area():
    scenario = Scenario(random_starts=[RandomStarts(area=TRIANGLE)])
    x, y = np.array([scenario.started(seed).initial_pose[:2, 0] for seed in range(200)]).T
    assert np.hypot(x.mean(), y.mean() + 4 / 3) < 5 * 8 / np.sqrt(24 * 200)  # the centroid
    assert abs((y < 0).mean() - 0.75) < 5 * np.sqrt(0.75 * 0.25 / 200)  # the lower half of it


def test_a_run_is_that_of_the_record_and_is_run_again_to_the_bit(tmp_path):
    record = mars2d.run(crowd(), seed=4)
    assert record.scenario == crowd().started(4)
    record.save(tmp_path / "a.npz")
    again = mars2d.load(tmp_path / "a.npz")
    assert rerun(again) is None
    assert record.digest == mars2d.run(crowd(), seed=4).digest
    timeline = Timeline(open_experiment(crowd(), seed=4))
    while not timeline.world.over:
        timeline.world.step()
    assert timeline.record.digest == record.digest


def test_with_no_seed_a_start_fails():
    """Of starts that are drawn without looking, some overlap."""
    eight = Scenario(robots=8, on_exit="wall", random_starts=[RandomStarts()])
    for seed in range(40):
        eight.started(seed).replace()  # refuses starts that overlap, or that are in a wall
    drawn = np.random.default_rng(0).uniform(-5, 5, (40, 8, 3))
    failed = 0
    for poses in drawn:
        try:
            Scenario(robots=[Robot(pose=pose) for pose in poses], on_exit="wall")
        except InputError:
            failed += 1
    assert failed > 4


@each_case(
    ("changes", "words"),
    [
        (
            [RandomStarts(["gest"])],
            r"random_starts\[0\]: there is no .* 'gest'; did you mean 'guest'",
        ),
        (
            [RandomStarts(), RandomStarts(["guest"])],
            r"\[1\]: 'guest' is in Scenario.random_starts\[0\]",
        ),
        (
            [RandomStarts(least_distance=3.5)],
            r"\[0\]: found no place in 20 rounds for 'robot\d', which needs 0.[16] m",
        ),
        ([RandomStarts(["crate"], area=[(9, 9), (8, 9), (8, 8)])], r"for 'crate', which needs"),
        (RandomStarts(), r"Scenario.random_starts = RandomStarts\(\): expected a list"),
    ],
)
def test_bad_ones_are_refused_in_words(changes, words):
    with pytest.raises(InputError, match=words):
        crowd(random_starts=changes)


def test_what_a_joint_ties_and_what_has_no_area_is_refused():
    with pytest.raises(InputError, match=r"\[0\]: a joint ties 'crate'"):
        crowd(joints=[Rope(a="crate", b="bar")], random_starts=[RandomStarts(["crate"])])
    with pytest.raises(InputError, match=r"\[0\]: expected an area, since the scenario has no"):
        Scenario(workspace=None, random_starts=[RandomStarts()])
    with pytest.raises(InputError, match=r"RandomStarts.bodies = 'red': expected names"):
        RandomStarts("red")
