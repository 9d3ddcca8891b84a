"""The examples in which robots know what their sensors tell, and nothing else."""

import dataclasses

import numpy as np
import pytest

import mars2d
from mars2d.scenario.experiment import open_experiment
from tests.worlds import failing, predicted

pytestmark = pytest.mark.slow

EXAMPLES = ("braitenberg", "wall_follower", "obstacle_avoidance", "dead_reckoning")


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("braitenberg", {}),
        ("braitenberg", {"gain": 12.0}),
        ("braitenberg", {"base": 8.0}),
        ("wall_follower", {}),
        ("wall_follower", {"damping": 0.6}),
        ("wall_follower", {"damping": 1}),
        ("wall_follower", {"damping": 1.5}),
        ("wall_follower", {"distance": 0.7, "noise": 0.01}),
        ("obstacle_avoidance", {"stop_time": 30.0}),
        ("obstacle_avoidance", {"stop_time": 20.0, "robots": 40}),
        ("obstacle_avoidance", {"stop_time": 20.0, "horizon": 0.2}),
        ("dead_reckoning", {}),
        ("dead_reckoning", {"drift": 0.002}),
    ],
)
def test_an_example_agrees_with_its_predictions(name, options):
    _, predictions = predicted(name, **options)
    assert predictions
    assert [p for p in predictions.values() if not p.ok] == []


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("braitenberg", {"gain": 0}, "gain = 0: expected 0 < base < gain"),
        ("braitenberg", {"base": 0}, "base = 0, gain = 8.0: expected 0 < base"),
        ("obstacle_avoidance", {"robots": 200}, "robots = 200: expected 2 to 40, as many as there"),
    ],
)
def test_options_that_an_example_can_not_be_run_with_are_refused_by_name(name, options, message):
    with pytest.raises(mars2d.InputError, match=message):
        open_experiment(name, options)


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.nightly)])
@pytest.mark.parametrize("name", ["braitenberg", "wall_follower", "dead_reckoning"])
def test_other_seeds_agree_too(name, seed):
    _, predictions = predicted(name, seed=seed)
    assert [p for p in predictions.values() if not p.ok] == []


@pytest.mark.parametrize("name", EXAMPLES)
def test_all_laws_see_sensors_only(name):
    robots = open_experiment(name).scenario.robots
    assert {robot.sees for robot in robots} == {"sensors"}
    assert all(robot.controller is not None for robot in robots)


# -- braitenberg ------------------------------------------------------------------------------


def test_fear_and_the_explorer_go_away_and_aggression_and_love_come():
    record, _ = predicted("braitenberg")
    names = [robot.name for robot in record.scenario.robots]
    assert names == ["fear", "aggression", "love", "explorer"]
    lamps = [addon.at for addon in record.scenario.addons]
    away = np.min([np.hypot(*(record.pose[:, :2].swapaxes(0, 1).T - lamp).T) for lamp in lamps], 0)
    assert away.shape == (len(record), 4)
    fear, aggression, love, explorer = away.T
    assert fear.min() > 1.5
    assert fear[-1] > fear[0]
    assert explorer.min() > 1.5
    assert aggression.min() < 0.05
    assert np.all(np.diff(love[:150]) < 0)
    assert np.ptp(love[-20:]) < 0.02


def test_the_checks_of_braitenberg_see_a_vehicle_that_does_not_what_it_should():
    record, _ = predicted("braitenberg")
    pose = record.pose.copy()
    pose[:, 0, 1] += 1.0
    pose[:, :2, 2] *= 1.2
    pose[-1, :, 0] = pose[-2, :, 0]
    assert failing("braitenberg", dataclasses.replace(record, pose=pose)) == {
        "fear: pace in the dark",
        "aggression: nearest to a lamp",
        "love: rests before a lamp at",
    }


# -- wall_follower ----------------------------------------------------------------------------


def test_the_wall_follower_comes_all_round_its_room():
    record, _ = predicted("wall_follower")
    x, y, heading = record.pose[:, :, 0].T
    assert heading[-1] == pytest.approx(-2 * np.pi, abs=0.2)  # one turn to the right
    near_a_wall = [y > 2, x > 4, y < -2, x < -4]
    assert all(near.any() for near in near_a_wall)
    assert x[-1] > x[0]
    assert y[-1] == pytest.approx(2.5, abs=0.15)


def test_less_damping_comes_nearer_to_the_wall():
    records = [predicted("wall_follower", damping=z, stop_time=20.0)[0] for z in (0.2, 0.5)]
    nearest = [record.pose[:, 1, 0].max() for record in records]
    assert nearest[0] > nearest[1] + 0.05


def test_the_checks_of_the_wall_follower_see_another_path():
    record, _ = predicted("wall_follower")
    pose = record.pose.copy()
    pose[:, 1] -= 0.05
    assert failing("wall_follower", dataclasses.replace(record, pose=pose)) == {
        "least distance to the first wall",
        "farthest from the curve of theory",
    }


# -- obstacle_avoidance -------------------------------------------------------------------------


def test_the_robots_spread_over_the_hall():
    record = mars2d.run("obstacle_avoidance", stop_time=30.0)
    x, y, _ = record.pose.swapaxes(0, 1)
    assert len(record.scenario.robots) == 20
    assert x[0].max() < 0
    assert (x[-1] > 0).sum() >= 5
    assert np.abs([x, y]).max() < 5 - 0.15


def test_one_that_uses_up_too_much_of_its_room_comes_too_near():
    options = {"stop_time": 30.0, "horizon": 0.03}
    failed = [
        each.name
        for seed in range(3)
        for each in predicted("obstacle_avoidance", seed, **options)[1].values()
        if not each.ok
    ]
    assert "robots nearer to each other than GAP, by" in failed


def test_the_checks_of_obstacle_avoidance_see_who_stands_still():
    record, _ = predicted("obstacle_avoidance", stop_time=20.0)
    pose = record.pose.copy()
    pose[100:, :, 3] = pose[100, :, 3]
    found = failing("obstacle_avoidance", dataclasses.replace(record, pose=pose), stop_time=20.0)
    assert "robots that come to a stop" in found


# -- dead_reckoning -----------------------------------------------------------------------------


def test_all_believe_to_be_home_and_none_is():
    record, _ = predicted("dead_reckoning")
    belief, truth = record.sensors["odometry"][-1, :, :2], record.pose[-1, :2].T
    assert np.hypot(*belief.T).max() < 0.06
    assert np.hypot(*truth.T).mean() > 0.5


def test_without_drift_all_are_where_they_believe_to_be():
    record = mars2d.run("dead_reckoning", options={"drift": 0.0, "robots": 3})
    belief = record.sensors["odometry"].swapaxes(1, 2)
    assert np.abs(belief - record.pose).max() < 1e-9


def test_the_ellipse_is_seen_to_grow():
    scene = mars2d.run("dead_reckoning", options={"robots": 3}).drawn
    outlines = [
        shape.points
        for shape in scene.shapes
        if hasattr(shape, "fill") and hasattr(shape, "points")
    ]
    areas = [np.sqrt(np.linalg.det(np.cov(points.T))) for points in outlines]
    assert len(areas) == 7
    assert areas[:5] == sorted(areas[:5])


def test_the_checks_of_dead_reckoning_see_errors_of_another_size():
    record, _ = predicted("dead_reckoning")
    odometry = record.sensors["odometry"]
    truth = record.pose.swapaxes(1, 2)
    sensors = {"odometry": truth + 1.5 * (odometry - truth)}
    assert len(failing("dead_reckoning", dataclasses.replace(record, sensors=sensors))) == 2
