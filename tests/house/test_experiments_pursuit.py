"""The pursuits of the paper: what it found, and what theory says of it."""

from math import hypot

import numpy as np
import pytest

from mars2d.geometry.voronoi import Tessellation
from tests.worlds import played

pytestmark = [pytest.mark.slow, pytest.mark.nightly]


def areas(record):
    """The area of the evader's cell at each row."""
    region, last = record.scenario.workspace, record.pose.shape[2] - 1
    return np.array([Tessellation(at, region).areas[last] for at in record.pose[:, :2]])


# -- pursuit_corners ----------------------------------------------------------------------------


@pytest.mark.parametrize(("mu", "winner"), [(0.94, "evader"), (0.955, "pursuer"), (1, "pursuer")])
def test_capture_begins_where_the_cycle_gets_as_narrow_as_a_robot(mu, winner):
    """The formula says 0.9446."""
    _, outcome, predictions = played("pursuit_corners", mu=mu)
    assert outcome.winner == winner
    assert all(p.ok for p in predictions)


def test_a_thinner_evader_is_caught_by_a_quicker_pursuer_only():
    _, outcome, predictions = played("pursuit_corners", mu=0.96, **{"robots.*.diameter": 0.3})
    assert outcome.winner == "evader"
    assert predictions[0].ok
    assert predictions[0].predicted == pytest.approx(0.389, abs=1e-3)


def test_on_a_straight_way_r_times_mu_plus_cos_phi_grows_by_one_minus_mu_squared():
    record, _, _ = played("pursuit_corners", mu=0.8, stop_time=200)
    x, y = (record.pose[:, :2, 1] - record.pose[:, :2, 0]).T
    way = record.command[:, :, 1].T / 0.2
    grown = np.diff(0.8 * np.hypot(x, y) + x * way[0] + y * way[1]) / 0.02
    straight = (np.abs(way[:, 1:] - way[:, :-1]) < 1e-6).all(axis=0)
    assert straight.mean() > 0.95
    assert np.median(grown[straight]) == pytest.approx(1 - 0.8**2, abs=3e-3)


# -- pursuit_voronoi ----------------------------------------------------------------------------


def test_it_does_so_from_other_starts_too():
    rng = np.random.default_rng(1)
    starts = [at for at in rng.uniform(-4.5, 4.5, (12, 2)) if hypot(*(at + 4.5)) > 2][:4]
    for x, y in starts:
        record, outcome, _ = played("pursuit_voronoi", **{"robots.0.pose": (x, y, 0)})
        assert 45 < outcome.capture_time < 101, record.over_message


def test_it_does_not_at_0_7():
    assert played("pursuit_voronoi", ratio=0.7, stop_time=150)[1].winner == "evader"


@pytest.mark.parametrize("start", [(1, 2), (-2, -1), (4, 4)])
def test_at_equal_speeds_the_evaders_cell_grows_only_while_the_pursuer_turns(start):
    record, outcome, predictions = played(
        "pursuit_voronoi", ratio=1.0, **{"robots.0.pose": (*start, 0)}
    )
    assert outcome.winner == "pursuer"
    rising = np.diff(areas(record)) > 0
    assert rising.mean() < 0.12
    assert abs(record.command[:-1, 1, 0][rising]).min() > 0.06  # rad/s
    assert all(p.ok for p in predictions)


def test_at_0_8_the_evaders_cell_may_grow():
    """So the test of equal speeds can fail."""
    record, _, _ = played("pursuit_voronoi")
    rising = np.diff(areas(record)) > 0
    assert 0.2 < rising.mean() < 0.35
    assert abs(record.command[:-1, 1, 0][rising]).min() < 0.03


def test_the_rate_of_a_cells_area_is_that_of_the_formula():
    """Central differences over random points and velocities, three robots."""
    rng = np.random.default_rng(2)
    region, h = ((-5, -5), (-5, 5), (5, 5), (5, -5)), 1e-6
    for _ in range(20):
        at, velocity = rng.uniform(-4, 4, (2, 3)), rng.normal(size=(2, 3))
        cells = Tessellation(at, region)
        rate = 0.0
        for i in cells.neighbours(2):
            a, b = np.array(cells.edge(i, 2))
            to = ((a + b) / 2)[:, None] - at
            part = np.hypot(*(a - b)) / np.hypot(*(at[:, i] - at[:, 2]))
            rate += part * (to[:, 2] @ velocity[:, 2] - to[:, i] @ velocity[:, i])
        later, sooner = (Tessellation(at + s * h * velocity, region).areas[2] for s in (1, -1))
        assert (later - sooner) / (2 * h) == pytest.approx(rate, abs=1e-5)
