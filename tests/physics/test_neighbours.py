"""No pair that may touch is ever missed: against all pairs, and against all walls."""

from __future__ import annotations

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st

from mars2d.physics.islands.neighbours import FEW, FEW_WALLS, Neighbours
from tests.cases import each_case
from tests.islands import DISC, body_of, piece_of, place, wall_of


class Walk:
    """Discs among walls, which move by less than was thought possible; and who may touch."""

    def __init__(self, places, radii, walls=(), passing=()):
        self.bodies = [body_of(piece_of(DISC, float(r)), number=k) for k, r in enumerate(radii)]
        self.ends = list(walls)
        self.passing = set(passing)
        edges = [wall_of(*ends, number=k) for k, ends in enumerate(self.ends)]
        self.near = Neighbours(self.bodies, edges, self.passing)
        self.put(places)

    def put(self, places) -> None:
        self.places = np.asarray(places, dtype=complex)
        for body, at in zip(self.bodies, self.places.tolist(), strict=True):
            place(body, at)
            body.start_x, body.start_y = body.x, body.y

    def ask(self, ways) -> tuple[set, set]:
        """Return the pairs of bodies, and of bodies and walls, that are said to be within reach."""
        for body, way in zip(self.bodies, np.broadcast_to(ways, len(self.bodies)), strict=True):
            body.way = float(way)
        self.near.refresh()
        pairs = {
            (pair.a.number, pair.b.number)
            for pair in self.near.pairs
            if pair.apart() <= pair.a.way + pair.b.way
        }
        walls = {
            (body.number, pair.wall.number)
            for body in self.bodies
            if self.near.at_wall(body)
            for pair in body.wall_pairs
            if pair.apart() <= body.way
        }
        return pairs, walls

    def truth(self) -> tuple[set, set]:
        """Return the same, tried one by one."""
        radii = np.array([body.radius for body in self.bodies])
        way = np.array([body.way for body in self.bodies])
        gap = np.abs(self.places[:, None] - self.places) - radii[:, None] - radii
        i, j = np.nonzero(np.triu(gap <= way[:, None] + way, 1))
        pairs = set(zip(i.tolist(), j.tolist(), strict=True)) - self.passing
        k, number = np.nonzero(self.wall_gaps() <= way[:, None])
        return pairs, set(zip(k.tolist(), number.tolist(), strict=True))

    def wall_gaps(self) -> np.ndarray:
        """Return how far all bodies are from all walls, as shapely says."""
        points = shapely.points(self.places.real, self.places.imag)
        edges = [shapely.LineString([(z.real, z.imag) for z in ends]) for ends in self.ends]
        radii = np.array([body.radius for body in self.bodies])
        gaps = shapely.distance(points[:, None], np.array(edges, dtype=object)[None, :])
        return gaps.astype(float) - radii[:, None]

    def go(self, rng) -> None:
        """Move each body by at most its way."""
        self.near.advance()
        way = np.array([body.way for body in self.bodies])
        n = len(way)
        self.put(self.places + way * rng.uniform(0, 1, n) * np.exp(1j * rng.uniform(0, 7, n)))


def walk(seed: int, n: int, walls: int, box: float, ticks: int) -> Walk:
    """Let discs walk at random, and compare what is said to the truth."""
    rng = np.random.default_rng(seed)

    def points(count: int) -> np.ndarray:
        return rng.uniform(-box, box, count) + 1j * rng.uniform(-box, box, count)

    ends = list(zip(points(walls).tolist(), points(walls).tolist(), strict=True))
    passing = {(0, 1), (2, 5)} if n > 5 else set()
    one = Walk(points(n), rng.uniform(0.05, 0.3, n), ends, passing)
    for _ in range(ticks):
        pairs, walled = one.ask(rng.uniform(0, 0.2, n) * rng.choice([0.05, 1.0, 3.0]))
        true_pairs, true_walls = one.truth()
        assert pairs == true_pairs
        assert walled == true_walls
        one.go(rng)
    return one


@given(seed=st.integers(0, 2**32), n=st.integers(1, 7), walls=st.integers(0, 3))
def test_among_few_bodies_no_pair_and_no_wall_is_missed(seed, n, walls):
    walk(seed, n, walls, box=1.5, ticks=5)


@each_case("seed", range(3))
@each_case("walls", [3, FEW_WALLS + 4])
def test_among_many_bodies_no_pair_and_no_wall_is_missed(seed, walls):
    walk(seed, FEW + 12, walls, box=4.0, ticks=8)


def test_among_bodies_far_apart_no_pair_is_missed():
    """Cells of a torus: what is kilometres away may fall into the same one."""
    rng = np.random.default_rng(4)
    n = FEW + 30
    towns = rng.choice([0, 1e3, -1e3 - 1e3j, 1e6j], n)
    one = Walk(towns + rng.uniform(-1, 1, n) + 1j * rng.uniform(-1, 1, n), np.full(n, 0.2))
    for _ in range(10):
        assert one.ask(rng.uniform(0, 0.1, n))[0] == one.truth()[0]
        one.go(rng)


def test_a_sudden_long_way_finds_what_was_not_listed():
    n = FEW + 2
    walls = [(complex(k, 9), complex(k, 20)) for k in range(FEW_WALLS + 1)]
    one = Walk(10.0 * np.arange(n) + 0j, np.full(n, 0.1), walls)
    assert one.ask(0.001) == (set(), set())
    pairs, walled = one.ask(9.0)
    assert pairs == {(k, k + 1) for k in range(n - 1)}
    assert walled == one.truth()[1] != set()


@each_case("n", [4, FEW + 8])
def test_pairs_that_pass_each_other_are_not_listed_however_many_bodies_there_are(n):
    places = np.arange(n) * 10.0 + 0j
    places[1] = places[0] + 0.1  # deep in each other
    places[3] = places[2] + 0.15
    passing = Walk(places, np.full(n, 0.1), passing=[(0, 1)])
    assert passing.ask(0.01)[0] == {(2, 3)}
    assert Walk(places, np.full(n, 0.1)).ask(0.01)[0] == {(0, 1), (2, 3)}
