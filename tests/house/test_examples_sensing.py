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


# -- wall_follower ----------------------------------------------------------------------------


# -- obstacle_avoidance -------------------------------------------------------------------------


# -- dead_reckoning -----------------------------------------------------------------------------


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
