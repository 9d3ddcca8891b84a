"""The examples about pushing: their predictions hold, on both sides of every threshold."""

import pytest

from mars2d.core.materials import GRAVITY
from tests.worlds import predicted

pytestmark = [pytest.mark.slow, pytest.mark.nightly]

NAMES = ["head_on", "push_box", "many_push_one", "wall_slide", "billiards"]


def wrong(predictions):
    return [p for p in predictions.values() if not p.ok]


@pytest.mark.parametrize("mu", [0.3, 0.4, 0.49, 0.5, 0.509, 0.51, 0.6, 0.7])
def test_push_box(mu):
    _, predictions = predicted("push_box", mu=mu)
    assert not wrong(predictions)
    stays = [mass for mass in (0.5, 1, 1.04, 2) if mu * mass * GRAVITY > 5]
    assert [
        m for m in (0.5, 1, 1.04, 2) if predictions[f"box of {m:g} kg: path"].predicted == 0
    ] == stays


@pytest.mark.parametrize("share", [0.98, 1.02])
@pytest.mark.parametrize("team", [1, 2, 3, 4])
def test_many_push_one_near_the_threshold_of_each_team(team, share):
    mu = share * team * 7.0 / (10 * GRAVITY)
    record, predictions = predicted("many_push_one", mu=mu)
    assert not wrong(predictions)
    moved = record.prop_pose[-1, 0] - record.prop_pose[0, 0] > 0.1
    assert moved.tolist() == [k >= team + (share > 1) for k in (1, 2, 3, 4)]


@pytest.mark.parametrize("angle", [10, 25, 40, 60, 80])
def test_wall_slide(angle):
    _, predictions = predicted("wall_slide", angle=angle)
    assert not wrong(predictions)
    slides = [p.measured > 1e-4 for name, p in predictions.items() if "slides" in name]
    assert slides == [True, True, True, False]


@pytest.mark.parametrize("physics", ["ideal", "stop"])
@pytest.mark.parametrize("name", NAMES)
def test_without_forces_predictions_fail(name, physics):
    _, predictions = predicted(name, physics=physics)
    assert len(wrong(predictions)) >= len(predictions) / 2
