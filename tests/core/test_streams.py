"""Random streams depend on the seed and their name, on nothing else."""

from __future__ import annotations

import numpy as np

from mars2d.core.streams import check_seed, stream
from tests.cases import each_case


def test_the_same_seed_and_name_give_the_same_numbers():
    assert np.array_equal(stream(7, "robot a").random(9), stream(7, "robot a").random(9))


@each_case(
    "other", [(8, "robot a"), (7, "robot b"), (7, "robot a "), (7 + 2**32, "robot a"), (7, "")]
)
def test_another_seed_or_name_gives_other_numbers(other):
    assert not np.isin(stream(7, "robot a").random(99), stream(*other).random(99)).any()


def test_streams_of_neighbouring_seeds_are_not_correlated():
    draws = np.array([stream(seed, "control").normal(size=400) for seed in range(20)])
    correlation = np.corrcoef(draws) - np.eye(20)
    assert np.abs(correlation).max() < 0.25


def test_the_numbers_stay_the_same_in_later_versions():
    assert stream(0, "control").integers(1000, size=4).tolist() == [662, 295, 792, 384]


@each_case("seed", [0, 1, 2**63 - 1, np.int64(5), np.uint8(3)])
def test_a_seed_is_a_whole_number(seed):
    assert check_seed(seed) == int(seed)
    assert type(check_seed(seed)) is int
