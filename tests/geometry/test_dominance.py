"""Dominance regions: Apollonius circles, bisectors, ovals; against races that are run."""

import numpy as np
import pytest

from mars2d.geometry import dominance
from tests.cases import each_case

EVADER, PURSUER = np.array([1.0, 2.0]), np.array([-1.0, 0.5])
APART = np.hypot(*(EVADER - PURSUER))


def test_without_a_capture_distance_it_is_the_circle_of_apollonius():
    for mu in (0.3, 0.7, 0.95):
        middle = (EVADER - mu**2 * PURSUER) / (1 - mu**2)
        radius = mu * APART / (1 - mu**2)
        away = np.hypot(*(dominance(EVADER, PURSUER, mu) - middle[:, None]))
        assert away == pytest.approx(np.full(360, radius))


def test_of_equals_it_is_the_bisector_where_there_is_one():
    edge = dominance(EVADER, PURSUER, 1.0)
    to_evader, to_pursuer = (np.hypot(*(edge - at[:, None])) for at in (EVADER, PURSUER))
    near = to_evader < 999
    assert 100 < near.sum() <= 180
    assert to_evader[near] == pytest.approx(to_pursuer[near])
    assert to_evader[~near] == pytest.approx(1000.0)  # on straight ways it is never caught


@each_case("ratio", [0.4, 0.8, 1.0])
@each_case("capture", [0.0, 0.5, 1.5])
def test_a_race_to_a_point_is_won_just_inside_and_lost_just_outside(ratio, capture):
    """Both run straight to the point, in small steps."""
    edge = dominance(EVADER, PURSUER, ratio, capture, count=16)
    for point in edge.T[np.hypot(*(edge - EVADER[:, None])) < 50]:
        for share, escapes in ((0.999, True), (1.001, False)):
            goal = EVADER + share * (point - EVADER)
            needs = np.hypot(*(goal - EVADER)) / ratio  # while the pursuer goes 1 m/s
            t = np.linspace(0, 1, 4001)[:, None]
            evader = EVADER + t * (goal - EVADER)
            way = goal - PURSUER
            gone = np.minimum(t * needs / np.hypot(*way), 1)
            apart = np.hypot(*(evader - PURSUER - gone * way).T)
            assert (apart.min() > capture) == escapes or abs(apart.min() - capture) < 1e-9


def test_who_stands_in_the_capture_distance_has_no_region():
    assert dominance(EVADER, PURSUER, 0.5, float(APART)) == pytest.approx(
        np.tile(EVADER[:, None], 360)
    )
