"""Coverage against theory: H, centroids, hexagons, rings, and what a moved start changes."""

from __future__ import annotations

from math import pi, sin, tan

import numpy as np
import pytest

import mars2d
from mars2d.geometry.voronoi import Tessellation
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment, open_module
from tests.worlds import predicted, solution

pytestmark = [pytest.mark.slow, pytest.mark.nightly]


SQUARE = ((0.0, 0.0), (5.0, 0.0), (5.0, 5.0), (0.0, 5.0))


def costs(record, rows):
    voronoi = record.scenario.addons[0]
    return [voronoi.of(record.frame(row)).cost for row in rows]


def test_in_a_square_the_cost_never_rises_and_robots_end_at_their_centroids():
    record, found = predicted("coverage_square", holonomic=True)
    assert [each.name for each in found.values() if not each.ok] == []
    assert found["largest rise of H"].measured == 0.0
    assert found["farthest from its centroid"].measured < 1e-3
    assert len(record.contacts) == 0
    at = [int(np.searchsorted(record.time, time)) for time in (1, 30, 60, 200)]
    early, late, steady, end = costs(record, at)
    assert early > 10 * end
    assert steady < 1.01 * end < late  # almost steady at 60 s, as the paper says


def test_the_cost_falls_at_the_rate_of_the_gradient():
    """H' = - 2 k sum M ahead^2 for unicycles, since those go only along their headings."""
    k = 0.1  # so that no speed is bounded
    scenario = open_experiment(examples()["coverage_square"], {"k": k}).scenario
    record = mars2d.run(scenario.replace(sampling_time=1e-3, stop_time=2e-3))
    x, y, theta = record.pose[1]
    cells = Tessellation([x, y], SQUARE)
    way = cells.centroids - cells.points
    ahead = np.cos(theta) * way[0] + np.sin(theta) * way[1]
    before, after = costs(record, (0, 2))
    rate = (after - before) / (record.time[2] - record.time[0])
    assert rate == pytest.approx(-2 * k * (cells.masses @ ahead**2), rel=1e-3)


def test_in_a_circle_one_start_moved_by_a_tenth_of_a_metre_ends_elsewhere():
    ends, inside = [], []
    for moved in (0.0, 0.1):
        record, found = predicted("coverage_circle", moved=moved)
        assert [each.name for each in found.values() if not each.ok] == []
        assert len(found) == (2 if moved else 4)
        starts = record.scenario.initial_pose
        ends.append(record.pose[-1, :2])
        inside.append(int((np.hypot(*ends[-1]) < 2.5 / 3).sum()))
    other = open_experiment(examples()["coverage_circle"], {}).scenario.initial_pose
    assert np.abs(starts - other).sum() == pytest.approx(0.1)
    assert inside == [1, 2]
    assert np.hypot(*(ends[1] - ends[0])).max() > 0.5


def test_the_formula_of_the_ring_is_that_of_its_cells():
    example = open_module("coverage_circle")
    disc = 2.5 * np.column_stack([np.cos(a := np.arange(2000) * pi / 1000), np.sin(a)])
    for m in (5, 7, 9):
        half, cost = example.ring(m)
        at = 2 * half * np.exp(2j * pi * np.arange(m) / m)
        found = Tessellation([[0, *at.real], [0, *at.imag]], disc)
        assert found.centroids == pytest.approx(found.points, abs=1e-4)
        assert found.cost == pytest.approx(cost, rel=1e-4)
        h = pi / m
        area = 2.5**2 * h - half**2 * tan(h)
        assert 3 * area * half == pytest.approx(2.5**3 * sin(h) - half**3 * tan(h))


def test_the_model_answers_formula_without_a_middle_is_that_of_its_cells():
    answer = open_module(solution("coverage_circle"))
    disc = 2.5 * np.column_stack([np.cos(a := np.arange(2000) * pi / 1000), np.sin(a)])
    for n in (3, 6, 8):
        away, cost = answer.hollow(n)
        at = away * np.exp(2j * pi * np.arange(n) / n)
        found = Tessellation([at.real, at.imag], disc)
        assert found.centroids == pytest.approx(found.points, abs=1e-4)
        assert found.cost == pytest.approx(cost, rel=1e-4)


@pytest.mark.parametrize(
    ("options", "inside"), [({"n": 6, "middle": True}, 1), ({"n": 8}, 1), ({"n": 5}, 0)]
)
def test_which_arrangements_last_is_as_the_model_answer_says(options, inside):
    path = solution("coverage_circle")
    experiment = open_experiment(path, options)
    record = mars2d.run(experiment.scenario, stop_time=60)
    assert (np.hypot(*record.pose[-1, :2]) < 2.5 / 3).sum() == inside
    assert all(each.ok for each in experiment.predictions(record))
