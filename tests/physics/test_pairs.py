"""Gaps, normals and times until contact: against shapely, translations, and motion."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from mars2d.physics.islands.pair import Pair, PiecePair
from tests.cases import each_case
from tests.islands import DISC, SQUARE, body_of, let_move, piece_of, place, wall_of

LONG = 1e9
"""A time in which everything that comes nearer touches, seconds."""


def random_piece(rng, kinds=(1, 2, 3, 4, 5, 8)):
    """A disc, a needle or a convex polygon about its frame's origin, or somewhere beside it."""
    corners = rng.choice(kinds)
    angle = np.sort(rng.uniform(0, 2 * np.pi, corners))
    vertices = rng.uniform(0.1, 0.6) * np.exp(1j * angle) + rng.normal(0, 0.2) * 1j
    return vertices, rng.uniform(0.05, 0.3) if corners == 1 else 0.0


class Two:
    """Two pieces on bodies of their own, or one and a wall, and their pair."""

    def __init__(self, first, second, radius=(0.0, 0.0), *, wall=False):
        self.cores = np.asarray(first, dtype=complex), np.asarray(second, dtype=complex)
        self.radius = radius
        p, q = piece_of(first, radius[0]), piece_of(second, radius[1])
        self.a, self.b = body_of(p), body_of(q, number=1)
        if wall:
            edge = wall_of(*self.cores[1])
            self.pair = PiecePair(self.a, self.a, edge, p, edge.piece)
        else:
            self.pair = PiecePair(self.a, self.b, None, p, q)
        self.wall = wall
        self.put((0j, 0j))

    def put(self, position, angle=(0.0, 0.0)) -> Pair:
        """Put the bodies somewhere, and measure."""
        place(self.a, position[0], angle[0])
        place(self.b, position[1], angle[1])
        self.pair.measure()
        self.placed = [
            p + np.exp(1j * t) * core
            for p, t, core in zip(position, angle, self.cores, strict=True)
        ]
        return self.pair

    @property
    def normal(self) -> complex:
        return complex(self.pair.normal_x, self.pair.normal_y)


def scattered(seed, count, spread, **kinds):
    """Yield `count` pairs of random pieces at random poses."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        (first, r), (second, s) = random_piece(rng, **kinds), random_piece(rng, **kinds)
        two = Two(first, second, (r, s))
        position = rng.normal(0, spread, 2) + 1j * rng.normal(0, spread, 2)
        two.put(position, rng.uniform(-9, 9, 2))
        yield two


def core(vertices):
    """The hull of vertices (k,) in the world, as shapely has it."""
    return shapely.convex_hull(shapely.multipoints(np.column_stack([vertices.real, vertices.imag])))


def gap_of(first, second, radius=(0.0, 0.0)):
    """The gap and the normal of two pieces that stand as they are given."""
    two = Two(first, second, radius)
    return two.pair.gap, two.normal


def separation(first, second, direction):
    """How far two pieces are apart along directions (m,), negative if they overlap there."""
    along = np.conj(direction)[:, None]
    return (along * second).real.min(axis=1) - (along * first).real.max(axis=1)


# -- gaps and normals of pieces -------------------------------------------------------------


def test_the_gap_is_the_distance_by_the_shortest_way_along_the_normal():
    apart = 0
    for two in scattered(0, 300, 1.0):
        distance = core(two.placed[0]).distance(core(two.placed[1]))
        gap = two.pair.gap + sum(two.radius)
        assert gap == pytest.approx(distance, abs=1e-12) if distance > 0 else gap <= 1e-12
        assert abs(two.normal) == pytest.approx(1.0, abs=1e-12)
        along = separation(*two.placed, np.array([two.normal]))[0]
        assert along == pytest.approx(gap, abs=1e-12)
        apart += distance > 0
    assert apart > 150


def test_pieces_that_overlap_part_after_a_move_along_the_normal_by_the_depth():
    directions = np.exp(1j * np.linspace(0, 2 * np.pi, 2000))
    deep = 0
    for two in scattered(2, 150, 0.05, kinds=(2, 3, 4, 5, 8)):
        depth, normal, (a, b) = -two.pair.gap, two.normal, two.placed
        if depth < 1e-6:
            continue
        deep += 1
        assert core(a).distance(core(b + (depth + 1e-9) * normal)) == pytest.approx(1e-9, abs=1e-12)
        assert core(a).intersects(core(b + (depth - 1e-9) * normal))
        least = -separation(a, b, directions).max()
        assert depth - 1e-12 <= least <= depth + 5e-3
    assert deep > 75


@each_case("angle", [0.0, 0.3, 1.0, 2.5])
def test_what_lies_on_the_line_of_a_wall_but_beyond_its_end_is_apart(angle):
    turn = np.exp(1j * angle)
    wall = turn * np.array([0.1 + 0.2j, 1.3 + 0.2j])
    two = Two(turn * np.array([2.3 + 0.2j]), wall, (0.1, 0.0), wall=True)
    assert two.pair.gap == pytest.approx(0.9, abs=1e-12)
    assert two.normal == pytest.approx(-turn)
    two = Two(turn * np.array([2.3 + 0.2j, 3.0 + 0.2j]), wall, wall=True)
    assert two.pair.gap == pytest.approx(1.0, abs=1e-12)
    assert two.normal == pytest.approx(-turn)


def test_a_wall_that_runs_through_a_piece_overlaps_it_up_to_the_nearer_side():
    two = Two(SQUARE, [-3 + 0.4j, 3 + 0.4j], wall=True)
    assert two.pair.gap == pytest.approx(-0.1)
    assert two.normal == pytest.approx(1j)
    two = Two(SQUARE, [-3 + 0j, -0.45 + 0j], wall=True)  # it ends within
    assert two.pair.gap == pytest.approx(-0.05)
    assert two.normal == pytest.approx(-1 + 0j)


@each_case("offset", [0.0, 1e-16, 1e-12, 1e-9, -1e-16, -1e-12])
@each_case("angle", [0.0, 0.7, 4.0])
def test_faces_that_just_touch_have_their_normal(offset, angle):
    turn = np.exp(1j * angle)
    gap, normal = gap_of(turn * SQUARE, turn * (SQUARE + 1.0 + offset + 0.3j))
    assert gap == pytest.approx(offset, abs=1e-15)
    assert normal == pytest.approx(turn, abs=1e-12)


@each_case(
    ("vertices", "same"),
    [
        ([0j, 0j, 1 + 0j, 1j, 1j], [0j, 1 + 0j, 1j]),
        ([0j, 0.5 + 0j, 1 + 0j, 1j], [0j, 1 + 0j, 1j]),
        ([0j, 1e-200 + 0j, 1 + 0j, 1j], [0j, 1 + 0j, 1j]),
    ],
)
@each_case("other", [SQUARE, DISC, DISC + 3, np.array([2 + 0j, 3 + 0j])])
def test_corners_that_add_nothing_change_nothing(vertices, same, other):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gap, normal = gap_of(vertices, other)
    assert abs(normal) == pytest.approx(1.0)
    assert gap == pytest.approx(gap_of(same, other)[0], abs=1e-12)


# -- discs ----------------------------------------------------------------------------------

places = st.complex_numbers(max_magnitude=3, allow_nan=False)


def discs(position, radii=(0.1, 0.2)) -> Pair:
    """Two discs that have been measured."""
    a, b = (body_of(piece_of(DISC, r), number=k) for k, r in enumerate(radii))
    place(a, position[0])
    place(b, position[1])
    pair = Pair(a, b, None)
    pair.measure()
    return pair


def disc_at(position, start, end, radius=0.1) -> Pair:
    """A disc and a wall that have been measured."""
    a = body_of(piece_of(DISC, radius))
    place(a, position)
    pair = Pair(a, a, wall_of(start, end))
    pair.measure()
    return pair


def gap_to_segment(point: complex, start: complex, end: complex) -> float:
    """The distance, found by trying many points of the segment and refining round the best."""
    low, high = 0.0, 1.0
    for _ in range(30):
        along = np.linspace(low, high, 11)
        best = along[np.argmin(np.abs(start + along * (end - start) - point))]
        width = (high - low) / 10
        low, high = max(best - width, 0.0), min(best + width, 1.0)
    return float(np.abs(start + best * (end - start) - point))


@given(first=places, second=places)
def test_two_discs_are_apart_by_the_way_between_their_rims(first, second):
    pair = discs((first, second))
    assert pair.gap == pytest.approx(abs(second - first) - 0.3, abs=1e-14)
    if abs(second - first) > 1e-6:
        normal = (second - first) / abs(second - first)
        assert complex(pair.normal_x, pair.normal_y) == pytest.approx(normal, abs=1e-12)


@given(position=places, start=places, way=st.complex_numbers(min_magnitude=1e-3, max_magnitude=9))
def test_a_disc_and_a_wall_are_apart_by_the_way_to_its_nearest_point(position, start, way):
    pair = disc_at(position, start, start + way)
    distance = gap_to_segment(position, start, start + way)
    assert pair.gap == pytest.approx(distance - 0.1, abs=1e-6)
    shortest = complex(*pair.wall.way(position.real, position.imag))
    assert abs(shortest) == pytest.approx(pair.gap + 0.1, abs=1e-15)
    if distance > 1e-3:  # along the normal it comes to the wall
        reached = position + (pair.gap + 0.1) * complex(pair.normal_x, pair.normal_y)
        assert gap_to_segment(reached, start, start + way) < 1e-6


@given(first=places, second=places, way=st.complex_numbers(min_magnitude=0.1, max_magnitude=4))
def test_discs_as_pieces_have_the_same_gaps(first, second, way):
    two = Two(DISC, DISC, (0.1, 0.2))
    two.put((first, second))
    assert two.pair.gap == pytest.approx(discs((first, second)).gap, abs=1e-12)
    two = Two(DISC, [second, second + way], (0.1, 0.0), wall=True)
    two.put((first, 0j))
    assert two.pair.gap == pytest.approx(disc_at(first, second, second + way).gap, abs=1e-12)


# -- times until contact --------------------------------------------------------------------


class Motion:
    """A pair of two bodies that turn, and whose velocities turn: where they are over time."""

    def __init__(self, rng, spread, *, wall=False, spin=2.0, **kinds):
        (first, r), (second, s) = random_piece(rng, **kinds), random_piece(rng, **kinds)
        if wall:
            second, s = rng.normal(0, 1, 2) + 1j * rng.normal(0, 1, 2), 0.0
        self.two = Two(first, second, (r, s), wall=wall)
        self.start = rng.normal(0, spread, 2) + 1j * rng.normal(0, spread, 2)
        self.angle, self.spin = rng.uniform(-9, 9, 2), rng.normal(0, spin, 2)
        self.velocity, self.turn = (
            rng.normal(0, 1, 2) + 1j * rng.normal(0, 1, 2) for _ in range(2)
        )
        if wall:
            self.start[1] = self.angle[1] = 0.0
            self.spin[1] = self.velocity[1] = self.turn[1] = 0.0
        self.at(0.0)
        for k, body in enumerate((self.two.a, self.two.b)):
            let_move(body, self.velocity[k], self.spin[k], abs(self.turn[k]))

    def at(self, t: float) -> float:
        """Return the gap after a time."""
        position = self.start + self.velocity * t + self.turn * t**2 / 2
        return self.two.put(position, self.angle + self.spin * t).gap


def assert_lower_bound(motion: Motion, ask: str, depth: float) -> float:
    """Follow a motion up to the time that a method tells; return by how much it may get deeper."""
    gap = motion.at(0.0)
    floor = -max(gap + depth, depth / 64) + gap
    h = getattr(motion.two.pair, ask)(LONG, depth)
    assert h >= 0
    for t in np.linspace(0, min(h, 10.0), 25):
        assert motion.at(t) >= floor - 1e-12
    return (motion.at(min(h, 10.0)) - floor) / abs(floor)


@each_case(("wall", "depth"), [(False, 1e-4), (True, 1e-2)])
def test_before_the_time_to_touch_nothing_gets_deeper_than_allowed(depth, wall):
    rng = np.random.default_rng(5)
    left = []
    for _ in range(80):
        motion = Motion(rng, 0.5, wall=wall)
        assert motion.two.pair.time_to_touch(LONG, depth) > 0
        left.append(assert_lower_bound(motion, "time_to_touch", depth))
    assert sum(share < 0.01 for share in left) > 1  # the bound is met, not only kept


@given(seed=st.integers(0, 2**32), depth=st.floats(1e-5, 1e-2))
def test_until_the_time_to_touch_discs_get_no_deeper_than_allowed(seed, depth):
    rng = np.random.default_rng(seed)
    ends = rng.uniform(-1, 1, 4) @ np.array([[1, 0], [1j, 0], [0, 1], [0, 1j]])
    for pair in (
        discs(rng.uniform(-1, 1, 2) + 1j * rng.uniform(-1, 1, 2)),
        disc_at(complex(*rng.uniform(-1, 1, 2)), *ends),
    ):
        turn, way = (rng.uniform(-1, 1, 2) + 1j * rng.uniform(-1, 1, 2) for _ in range(2))
        bodies = [pair.a] if pair.is_wall else [pair.a, pair.b]
        starts = [complex(body.x, body.y) for body in bodies]
        for k, body in enumerate(bodies):
            let_move(body, way[k], 0.0, abs(turn[k]))
        floor = pair.gap - max(pair.gap + depth, depth / 64)
        h = pair.time_to_touch(LONG, depth)
        for t in np.linspace(0, min(h, 10.0), 20):
            for k, body in enumerate(bodies):
                place(body, starts[k] + way[k] * t + turn[k] * t**2 / 2)
            pair.measure()
            assert pair.gap >= floor - 1e-12


@each_case("seed", range(20))
def test_along_a_face_the_time_to_touch_of_a_translation_is_exact(seed):
    rng = np.random.default_rng(seed)
    corner = rng.uniform(1.0, 2.0) + 0.3j * rng.uniform(-1, 1)
    kite = corner + np.array([0j, 0.3 - 0.2j, 0.5 + 0j, 0.3 + 0.2j])
    angle, speed = rng.uniform(0, 6), rng.uniform(0.1, 2.0)
    two = Two(SQUARE, kite)
    two.put((0j, 0j), (angle, angle))
    let_move(two.a, 0j)
    let_move(two.b, np.exp(1j * angle) * speed * (-1 + 0.1j * rng.uniform(-1, 1)))
    h = two.pair.time_to_touch(LONG, 1e-3)
    assert h == pytest.approx((corner.real - 0.5 + 1e-3) / speed, abs=1e-9)


def test_a_bar_that_turns_on_a_spot_near_a_wall_is_not_held_up_by_its_other_corners():
    """The edge's bound sees that they turn away; asked one after the other, few are needed."""
    bar = np.array([-0.5 - 0.02j, 0.5 - 0.02j, 0.5 + 0.02j, -0.5 + 0.02j])
    two = Two(bar, [-9 - 0.53j, 9 - 0.53j], wall=True)
    let_move(two.a, 0j, 1.0)
    t, calls = 0.0, 0
    while t < np.pi and calls < 100:  # it passes the wall by 3 cm less half its thickness
        t += two.pair.time_to_touch(np.pi - t, 1e-3)
        two.put((0j, 0j), (t, 0.0))
        assert two.pair.gap > 0
        calls += 1
    assert t >= np.pi
    assert calls < 40


def test_what_moves_apart_or_stands_never_touches():
    two = Two(SQUARE, SQUARE)
    two.put((0j, 1 + 0j))
    let_move(two.a, -1 + 0j)
    assert two.pair.time_to_touch(1e6, 1e-3) == 1e6
    let_move(two.a, 0j)
    assert two.pair.time_to_touch(1e6, 1e-3) == 1e6
    let_move(two.a, -1 + 0j, acceleration=0.5)  # it comes back within 2 v / a
    assert 4.0 < two.pair.time_to_touch(1e6, 1e-3) < 4.002
