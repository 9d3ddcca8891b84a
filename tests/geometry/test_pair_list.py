"""A disc that is said to be free is free."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.spatial
from hypothesis import given
from hypothesis import strategies as st

from mars2d.geometry.pair_list import MAX_DISCS_ALL_PAIRS as FEW
from mars2d.geometry.pair_list import Clearance, DiscPairs, Walls

NOTHING = Walls(np.empty(0, complex), np.empty(0, complex))


def pairs_of(clearance: Clearance, radii, walls: Walls, center, who, reach: float) -> DiscPairs:
    """What is within reach of the discs `who`, measured."""
    clearance.measure(center)
    pairs = DiscPairs(radii[who], clearance.close(who, reach), walls)
    pairs.measure(center[who])
    return pairs


def gap_to_segment(point: complex, start: complex, edge: complex) -> float:
    """The distance, found by trying many points of the segment and refining round the best."""
    low, high = 0.0, 1.0
    for _ in range(30):
        along = np.linspace(low, high, 11)
        best = along[np.argmin(np.abs(start + along * edge - point))]
        width = (high - low) / 10
        low, high = max(best - width, 0.0), min(best + width, 1.0)
    return float(np.abs(start + best * edge - point))


def truly_near(center, radii, start, edge, reach) -> np.ndarray:
    """Which discs could touch something if each moves by its reach, tried one by one."""
    n = len(center)
    near = np.zeros(n, dtype=bool)
    for i in range(n):
        for j in range(n):
            if i != j:
                gap = abs(center[i] - center[j]) - radii[i] - radii[j]
                near[i] |= gap <= reach[i] + reach[j]
        for a, e in zip(start, edge, strict=True):
            near[i] |= gap_to_segment(center[i], a, e) - radii[i] <= reach[i]
    return near


def random_walk(seed: int, n: int, segments: int, ticks: int, box: float):
    """Yield (clearance's answer, truth) while discs move at random by less than their reach."""
    rng = np.random.default_rng(seed)

    def places(count: int) -> np.ndarray:
        return rng.uniform(-box, box, count) + 1j * rng.uniform(-box, box, count)

    radii = rng.uniform(0.05, 0.3, n)
    start, edge = places(segments), places(segments)
    clearance = Clearance(radii, Walls(start, edge))
    center = places(n)
    for _ in range(ticks):
        reach = rng.uniform(0, 0.2, n) * rng.choice([0.05, 1.0, 3.0])
        clearance.measure(center)
        answer = clearance.may_touch(reach)
        yield answer, truly_near(center, radii, start, edge, reach)
        clearance.moved(reach)
        center = center + reach * rng.uniform(0, 1, n) * np.exp(1j * rng.uniform(0, 7, n))


@given(seed=st.integers(0, 2**32), n=st.integers(1, 6), segments=st.integers(0, 3))
def test_among_few_discs_the_answer_is_exact(seed, n, segments):
    for answer, truth in random_walk(seed, n, segments, ticks=6, box=1.5):
        assert answer.tolist() == truth.tolist()


@pytest.mark.parametrize("seed", range(3))
def test_among_many_discs_nothing_within_reach_is_called_free(seed):
    n = FEW + 8
    for answer, truth in random_walk(seed, n, 3, ticks=12, box=6.0):
        assert not (truth & ~answer).any()


def test_among_many_discs_far_ones_are_called_free():
    answers = [answer for answer, _ in random_walk(5, FEW + 8, 2, ticks=6, box=30.0)]
    assert np.mean(answers) < 0.5


def test_pairs_are_listed_anew_only_when_discs_have_moved_by_the_skin(monkeypatch):
    n = FEW + 1
    clearance = Clearance(np.full(n, 0.1), NOTHING)
    trees = []

    class Tree(scipy.spatial.cKDTree):
        def __init__(self, points):
            super().__init__(points)
            trees.append(points)

    monkeypatch.setattr(scipy.spatial, "cKDTree", Tree)
    reach = np.full(n, 0.01)
    for _ in range(30):
        clearance.measure(np.arange(n) + 0j)
        clearance.may_touch(reach)
        clearance.moved(reach)
    assert 1 <= len(trees) <= 4


def test_a_sudden_long_reach_finds_discs_that_were_not_listed():
    n = FEW + 2
    clearance = Clearance(np.full(n, 0.1), NOTHING)
    center = 10.0 * np.arange(n) + 0j
    clearance.measure(center)
    assert not clearance.may_touch(np.full(n, 0.001)).any()
    assert clearance.may_touch(np.full(n, 5.0)).all()


@given(seed=st.integers(0, 2**32))
def test_pairs_of_discs_measure_every_gap_within_reach(seed):
    rng = np.random.default_rng(seed)
    n = 6
    center = rng.uniform(-1, 1, n) + 1j * rng.uniform(-1, 1, n)
    radii = rng.uniform(0.05, 0.3, n)
    start = rng.uniform(-1, 1, 3) + 1j * rng.uniform(-1, 1, 3)
    edge = rng.uniform(-1, 1, 3) + 1j * rng.uniform(-1, 1, 3)
    walls = Walls(start, edge)
    clearance = Clearance(radii, walls)
    reach = np.full(n, 0.2)
    clearance.measure(center)
    near = clearance.may_touch(reach)
    clearance.moved(reach)
    who = np.flatnonzero(near)
    pairs = pairs_of(clearance, radii, walls, center, who, 0.2)
    touching = np.zeros(n, dtype=bool)
    touching[who] = pairs.touching()
    expected = truly_near(center, radii, start, edge, np.zeros(n))
    assert touching.tolist() == expected.tolist()
    i, j, disc, segment = pairs.touching_pairs()
    touched = set()
    for a, b in zip(who[i], who[j], strict=True):
        assert abs(center[a] - center[b]) <= radii[a] + radii[b]
        touched |= {int(a), int(b)}
    for a, s in zip(who[disc], segment, strict=True):
        assert gap_to_segment(center[a], start[s], edge[s]) <= radii[a] + 1e-6
        touched.add(int(a))
    assert touched == set(np.flatnonzero(touching).tolist())
    points, normals = pairs.touching_points()
    assert np.abs(normals) == pytest.approx(np.ones(len(points)))
    first = np.concatenate([who[i], who[disc]])
    assert np.abs(points - center[first]) == pytest.approx(radii[first])


@pytest.mark.slow
@given(seed=st.integers(0, 2**32), depth=st.floats(1e-5, 1e-2))
def test_until_the_time_to_touch_nothing_gets_deeper_than_allowed(seed, depth):
    rng = np.random.default_rng(seed)
    n = 5
    radii = np.full(n, 0.1)
    center = np.arange(n) * 0.25 + 1j * rng.uniform(-0.1, 0.1, n)
    start, edge = np.array([-1 - 0.4j]), np.array([3 + 0.1j])
    walls = Walls(start, edge)
    clearance = Clearance(radii, walls)
    reach = np.full(n, 9.0)
    clearance.measure(center)
    clearance.may_touch(reach)
    clearance.moved(reach)
    pairs = pairs_of(clearance, radii, walls, center, np.arange(n), 9.0)
    velocity = rng.uniform(-1, 1, n) + 1j * rng.uniform(-1, 1, n)
    h = pairs.time_to_touch(velocity, np.zeros(n), depth)
    for part in np.linspace(0, min(h, 10.0), 20):
        at = center + velocity * part
        between = np.abs(at[:, None] - at[None, :])[np.triu_indices(n, 1)]
        assert (between - 0.2).min() >= -depth - 1e-9
        walls = [gap_to_segment(c, start[0], edge[0]) - 0.1 for c in at]
        assert min(walls) >= -depth - 1e-6


def test_things_that_move_apart_never_touch():
    clearance = Clearance(np.full(2, 0.1), NOTHING)
    center = np.array([0j, 1 + 0j])
    pairs = pairs_of(clearance, np.full(2, 0.1), NOTHING, center, np.arange(2), 9.0)
    apart = pairs.time_to_touch(np.array([-1 + 0j, 1 + 0j]), np.zeros(2), 1e-3)
    towards = pairs.time_to_touch(np.array([1 + 0j, -1 + 0j]), np.zeros(2), 1e-3)
    assert apart > 1e6
    assert towards == pytest.approx((0.8 + 1e-3) / 2)


def test_the_nearest_point_of_a_wall_may_be_its_end():
    walls = Walls(np.array([0j]), np.array([1 + 0j]))
    towards = walls.towards(np.array([0.5 + 2j, -3 - 4j, 4 + 4j]))
    assert np.abs(towards) == pytest.approx([2, 5, 5])


# -- pairs that pass through each other, and pairs that touch -------------------------------------


@pytest.mark.parametrize("n", [4, FEW + 8])
def test_pairs_that_pass_each_other_are_not_near_however_many_discs_there_are(n):
    center = np.arange(n) * 10.0 + 0j
    center[1] = center[0] + 0.1  # deep in each other
    center[3] = center[2] + 0.15
    radii, reach = np.full(n, 0.1), np.full(n, 0.01)
    passing = Clearance(radii, NOTHING, [(0, 1)])
    passing.measure(center)
    assert np.flatnonzero(passing.may_touch(reach)).tolist() == [2, 3]
    passing.moved(reach)
    close = passing.close(np.array([0, 1, 2, 3]), 0.01)
    assert list(zip(close.i.tolist(), close.j.tolist(), strict=True)) == [(2, 3)]
    meeting = Clearance(radii, NOTHING)
    meeting.measure(center)
    assert np.flatnonzero(meeting.may_touch(reach)).tolist() == [0, 1, 2, 3]


def test_a_disc_that_passes_one_other_still_meets_the_rest_and_the_walls():
    center = np.array([0j, 0.1 + 0j, 0.35 + 0j])
    walls = Walls(np.array([-1 + 0.12j]), np.array([0.9 + 0j]))  # ends at -0.1 + 0.12j
    clearance = Clearance(np.full(3, 0.1), walls, [(0, 1)])
    reach = np.full(3, 0.06)
    clearance.measure(center)
    assert clearance.may_touch(reach).all()
    clearance.moved(reach)
    close = clearance.close(np.arange(3), 0.06)
    assert list(zip(close.i.tolist(), close.j.tolist(), strict=True)) == [(1, 2)]
    assert close.disc.tolist() == [0]


def test_how_fast_discs_move_into_each_other_and_into_walls():
    center = np.array([0j, 0.2 + 0j, 5 + 0.1j])
    walls = Walls(np.array([4 + 0j]), np.array([2 + 0j]))
    radii = np.full(3, 0.1)
    clearance = Clearance(radii, walls)
    clearance.measure(center)
    clearance.may_touch(np.full(3, 0.1))
    clearance.moved(np.full(3, 0.1))
    pairs = pairs_of(clearance, radii, walls, center, np.arange(3), 0.1)
    assert pairs.touching().all()
    first, second = pairs.inwards(np.array([0.3 + 9j, -0.2 + 9j, 7 - 0.5j]))
    assert first == pytest.approx([0.3, 0.5])  # disc 0 into 1, disc 2 into the wall
    assert second == pytest.approx([0.2, 0.0])


def test_pairs_that_touch_are_left_out_of_the_time_to_touch_if_asked():
    center = np.array([0j, 0.2 + 0j, 1.2 + 0j])
    radii = np.full(3, 0.1)
    clearance = Clearance(radii, NOTHING)
    pairs = pairs_of(clearance, radii, NOTHING, center, np.arange(3), 9.0)
    velocity, still = np.array([1 + 0j, 0j, -1 + 0j]), np.zeros(3)
    assert pairs.time_to_touch(velocity, still, 1e-3) == pytest.approx(1e-3)
    alone = pairs.time_to_touch(velocity, still, 1e-3, again=False)
    assert alone == pytest.approx((1.0 + 1e-3) / 2)  # discs 0 and 2, as if 1 were not there
