"""The examples in which robots know what their sensors tell, and nothing else."""

import numpy as np
import pytest

import mars2d
from tests.worlds import predicted

pytestmark = [pytest.mark.slow, pytest.mark.nightly]


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("braitenberg", {"gain": 12.0}),
        ("braitenberg", {"base": 8.0}),
        ("wall_follower", {"damping": 0.6}),
        ("wall_follower", {"damping": 1}),
        ("wall_follower", {"damping": 1.5}),
        ("wall_follower", {"distance": 0.7, "noise": 0.01}),
        ("obstacle_avoidance", {"stop_time": 30.0}),
        ("obstacle_avoidance", {"stop_time": 20.0, "robots": 40}),
        ("obstacle_avoidance", {"stop_time": 20.0, "horizon": 0.2}),
        ("dead_reckoning", {"drift": 0.002}),
    ],
)
def test_an_example_agrees_with_its_predictions(name, options):
    _, predictions = predicted(name, **options)
    assert predictions
    assert [p for p in predictions.values() if not p.ok] == []


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.nightly)])
@pytest.mark.parametrize("name", ["braitenberg", "wall_follower", "dead_reckoning"])
def test_other_seeds_agree_too(name, seed):
    _, predictions = predicted(name, seed=seed)
    assert [p for p in predictions.values() if not p.ok] == []


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


# -- wall_follower ----------------------------------------------------------------------------


def test_the_wall_follower_comes_all_round_its_room():
    record, _ = predicted("wall_follower")
    x, y, heading = record.pose[:, :, 0].T
    assert heading[-1] == pytest.approx(-2 * np.pi, abs=0.2)  # one turn to the right
    near_a_wall = [y > 2, x > 4, y < -2, x < -4]
    assert all(near.any() for near in near_a_wall)
    assert x[-1] > x[0]
    assert y[-1] == pytest.approx(2.5, abs=0.15)


# -- obstacle_avoidance -------------------------------------------------------------------------


def test_the_robots_spread_over_the_hall():
    record = mars2d.run("obstacle_avoidance", stop_time=30.0)
    x, y, _ = record.pose.swapaxes(0, 1)
    assert len(record.scenario.robots) == 20
    assert x[0].max() < 0
    assert (x[-1] > 0).sum() >= 5
    assert np.abs([x, y]).max() < 5 - 0.15


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
