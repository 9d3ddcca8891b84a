"""Gaps between convex pieces against shapely, against translations, and against time."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import shapely

from mars2d.geometry.separation import ConvexPairs, Pieces

SQUARE = np.array([-0.5 - 0.5j, 0.5 - 0.5j, 0.5 + 0.5j, -0.5 + 0.5j])
DISC = np.array([0j])


def random_piece(rng, kinds=(1, 2, 3, 4, 5, 8)):
    """A disc, a wall or a convex polygon about its frame's origin, or somewhere beside it."""
    corners = rng.choice(kinds)
    angle = np.sort(rng.uniform(0, 2 * np.pi, corners))
    vertices = rng.uniform(0.1, 0.6) * np.exp(1j * angle) + rng.normal(0, 0.2) * 1j
    radius = rng.uniform(0.05, 0.3) if corners == 1 else 0.0
    return vertices, radius


def scattered(seed, count, spread, **kinds):
    """`count` pairs of pieces, each piece on a body of its own: pieces, pairs and poses."""
    rng = np.random.default_rng(seed)
    vertices, radius = zip(*[random_piece(rng, **kinds) for _ in range(2 * count)], strict=True)
    bodies = np.arange(2 * count)
    pieces = Pieces(vertices, np.array(radius))
    pairs = ConvexPairs(pieces, bodies, (bodies[::2], bodies[1::2]))
    position = rng.normal(0, spread, 2 * count) + 1j * rng.normal(0, spread, 2 * count)
    angle = rng.uniform(-9, 9, 2 * count)
    return vertices, np.array(radius), pairs, position, angle


def core(vertices):
    """The hull of vertices (k,) in the world, as shapely has it."""
    return shapely.convex_hull(shapely.multipoints(np.column_stack([vertices.real, vertices.imag])))


def placed(vertices, position, angle):
    return [core(p + np.exp(1j * a) * v) for v, p, a in zip(vertices, position, angle, strict=True)]


def pair_of(first, second, radius=(0.0, 0.0), body=(0, -1)):
    """A pair of two pieces, of which the second stands still unless it is given a body."""
    pieces = Pieces([np.asarray(first), np.asarray(second)], np.array(radius))
    return ConvexPairs(pieces, np.array(body), (np.array([0]), np.array([1])))


def gap_of(first, second, radius=(0.0, 0.0)):
    """The gap and the normal of two pieces that stand as they are given."""
    pair = pair_of(first, second, radius)
    pair.measure(np.zeros(1, dtype=complex), np.zeros(1))
    return float(pair.gap[0]), complex(pair.normal[0])


def separation(first, second, direction):
    """How far two pieces are apart along directions (m,), negative if they overlap there."""
    along = np.conj(direction)[:, None]
    return (along * second).real.min(axis=1) - (along * first).real.max(axis=1)


@pytest.mark.parametrize("seed", range(3))
def test_the_gap_of_pieces_that_are_apart_is_their_distance(seed):
    vertices, radius, pairs, position, angle = scattered(seed, 1500, 1.0)
    pairs.measure(position, angle)
    shapes = placed(vertices, position, angle)
    distance = shapely.distance(shapes[::2], shapes[1::2])
    apart = distance > 0
    assert apart.sum() > 1000
    gap = pairs.gap + radius[::2] + radius[1::2]
    assert np.abs(gap - distance)[apart].max() < 1e-12
    assert gap[~apart].max() <= 1e-12


@pytest.mark.parametrize("seed", range(3))
def test_the_normal_leads_from_the_first_piece_to_the_second_by_the_shortest_way(seed):
    vertices, radius, pairs, position, angle = scattered(seed, 500, 1.0)
    pairs.measure(position, angle)
    assert np.abs(pairs.normal) == pytest.approx(1.0, abs=1e-12)
    for m in range(500):
        a, b = (position[k] + np.exp(1j * angle[k]) * vertices[k] for k in (2 * m, 2 * m + 1))
        along = separation(a, b, pairs.normal[m : m + 1])[0] - radius[2 * m] - radius[2 * m + 1]
        assert along == pytest.approx(pairs.gap[m], abs=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_pieces_that_overlap_part_after_a_move_along_the_normal_by_the_depth(seed):
    vertices, _, pairs, position, angle = scattered(seed, 600, 0.05, kinds=(2, 3, 4, 5, 8))
    pairs.measure(position, angle)
    deep = np.flatnonzero(pairs.gap < -1e-6)
    assert len(deep) > 300
    directions = np.exp(1j * np.linspace(0, 2 * np.pi, 2000))
    for m in deep:
        depth, normal = -pairs.gap[m], pairs.normal[m]
        a, b = (position[k] + np.exp(1j * angle[k]) * vertices[k] for k in (2 * m, 2 * m + 1))
        assert core(a).distance(core(b + (depth + 1e-9) * normal)) == pytest.approx(1e-9, abs=1e-12)
        assert core(a).intersects(core(b + (depth - 1e-9) * normal))
        least = -separation(a, b, directions).max()
        assert depth - 1e-12 <= least <= depth + 5e-3


def test_a_disc_in_a_polygon_is_as_deep_as_its_nearest_edge_and_its_radius():
    gap, normal = gap_of(SQUARE, [0.3 + 0.1j], (0.0, 0.25))
    assert gap == pytest.approx(-0.2 - 0.25, abs=1e-15)
    assert normal == pytest.approx(1 + 0j)


def test_two_discs_are_measured_between_their_centres():
    gap, normal = gap_of(DISC, [3 + 4j], (1.0, 2.0))
    assert gap == pytest.approx(2.0, abs=1e-15)
    assert normal == pytest.approx(0.6 + 0.8j, abs=1e-15)


def test_discs_at_the_same_place_have_some_normal():
    gap, normal = gap_of(DISC, DISC, (0.1, 0.2))
    assert gap == pytest.approx(-0.3)
    assert abs(normal) == pytest.approx(1.0)


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.0, 2.5])
def test_what_lies_on_the_line_of_a_wall_but_beyond_its_end_is_apart(angle):
    turn = np.exp(1j * angle)
    wall = turn * np.array([0.1 + 0.2j, 1.3 + 0.2j])
    gap, normal = gap_of(wall, turn * np.array([2.3 + 0.2j]), (0.0, 0.1))
    assert gap == pytest.approx(0.9, abs=1e-12)
    assert normal == pytest.approx(turn)
    gap, normal = gap_of(wall, turn * np.array([2.3 + 0.2j, 3.0 + 0.2j]))
    assert gap == pytest.approx(1.0, abs=1e-12)
    assert normal == pytest.approx(turn)


def test_walls_that_cross_overlap():
    gap, normal = gap_of([-1 + 0j, 1 + 0j], [0.2 - 3j, 0.2 + 0.1j])
    assert gap == pytest.approx(-0.1)
    assert normal == pytest.approx(-1j)


@pytest.mark.parametrize("offset", [0.0, 1e-16, 1e-12, 1e-9, -1e-16, -1e-12])
@pytest.mark.parametrize("angle", [0.0, 0.7, 4.0])
def test_faces_that_just_touch_have_their_normal(offset, angle):
    turn = np.exp(1j * angle)
    gap, normal = gap_of(turn * SQUARE, turn * (SQUARE + 1.0 + offset + 0.3j))
    assert gap == pytest.approx(offset, abs=1e-15)
    assert normal == pytest.approx(turn, abs=1e-12)


def test_a_corner_on_a_corner_touches():
    gap, _ = gap_of(SQUARE, SQUARE + 1 + 1j)
    assert gap == pytest.approx(0.0, abs=1e-15)


def test_a_pose_of_a_body_moves_its_pieces():
    pair = pair_of(SQUARE, SQUARE, body=(0, 1))
    pair.measure(np.array([0j, 2 + 0j]), np.array([0.0, np.pi / 4]))
    assert pair.gap[0] == pytest.approx(1.5 - np.sqrt(0.5), abs=1e-12)
    assert pair.normal[0] == pytest.approx(1 + 0j)
    assert not pair.any_touch


def test_the_bodies_that_touch_are_named_as_they_were_given():
    pieces = Pieces([SQUARE, DISC, np.array([5 - 9j, 5 + 9j])], np.array([0.0, 0.1, 0.0]))
    pairs = ConvexPairs(pieces, np.array([1, 0, -3]), (np.array([0, 0, 1]), np.array([1, 2, 2])))
    pairs.measure(np.array([4.95 + 3j, 4.6 + 0j]), np.zeros(2))
    assert pairs.touch.tolist() == [False, True, True]
    assert pairs.any_touch
    first, second = pairs.touching_bodies()
    assert first.tolist() == [1, 0]
    assert second.tolist() == [-3, -3]


def test_pairs_without_members_never_touch():
    none = np.empty(0, dtype=np.intp)
    pairs = ConvexPairs(Pieces([], np.empty(0)), none, (none, none))
    pairs.measure(np.zeros(1, dtype=complex), np.zeros(1))
    assert not pairs.any_touch
    still = np.zeros(1)
    assert pairs.time_to_touch(still + 0j, still, still, 1e-3) == np.inf


@pytest.mark.parametrize(
    ("vertices", "same"),
    [
        ([0j, 0j, 0j], [0j]),
        ([0j, 0j], [0j]),
        ([0j, 1e-200 + 0j], [0j]),
        ([0j, 1 + 0j, 1 + 0j], [0j, 1 + 0j]),
        ([0j, 0.5 + 0j, 1 + 0j], [0j, 1 + 0j]),
        ([0j, 0j, 1 + 0j, 1j, 1j], [0j, 1 + 0j, 1j]),
    ],
)
@pytest.mark.parametrize("other", [SQUARE, DISC, DISC + 3, np.array([2 + 0j, 3 + 0j])])
def test_degenerate_pieces_are_measured_as_what_they_are(vertices, same, other):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gap, normal = gap_of(vertices, other)
    assert abs(normal) == pytest.approx(1.0)
    assert gap == pytest.approx(gap_of(same, other)[0], abs=1e-12)


def random_motion(seed, spread, **kinds):
    """One pair, measured, with a random motion of both bodies: it and their poses over time."""
    rng = np.random.default_rng(seed)
    _, _, pair, position, angle = scattered(seed, 1, spread, **kinds)
    velocity, turn = (rng.normal(0, 1, 2) + 1j * rng.normal(0, 1, 2) for _ in range(2))
    spin = rng.normal(0, 2, 2)
    bend = np.abs(turn)

    def pose(t):
        return position + velocity * t + turn * t**2 / 2, angle + spin * t

    pair.measure(position, angle)
    return pair, pose, (velocity, spin, bend)


@pytest.mark.slow
@pytest.mark.parametrize("depth", [1e-4, 1e-2])
def test_before_the_time_to_touch_nothing_gets_deeper_than_allowed(depth):
    reached = 0
    for seed in range(300):
        pair, pose, motion = random_motion(seed, spread=0.5)
        allowed = max(pair.gap[0] + depth, depth / 64) - pair.gap[0]
        h = pair.time_to_touch(*motion, depth)
        assert h > 0
        for t in np.linspace(0, min(h, 10.0), 25):
            pair.measure(*pose(t))
            assert pair.gap[0] >= -allowed - 1e-12
        reached += pair.gap[0] <= -0.99 * allowed
    assert reached > 5  # the bound is met, not only kept


@pytest.mark.parametrize("seed", range(5))
def test_few_bounds_one_after_the_other_lead_up_to_the_touch(seed):
    rng = np.random.default_rng(seed)
    wall = np.array([2 - 9j, 2 + 9j])
    box = SQUARE * rng.uniform(0.2, 1.0)
    pair = pair_of(box, wall)
    speed, spin = rng.uniform(0.2, 1.0), rng.uniform(-3, 3, 1)
    velocity = np.array([speed * np.exp(1j * rng.uniform(-1, 1))])
    t, calls, depth = 0.0, 0, 1e-3
    pair.measure(velocity * t, spin * t)
    while pair.gap[0] > 0:
        t += pair.time_to_touch(velocity, spin, np.zeros(1), depth)
        calls += 1
        pair.measure(velocity * t, spin * t)
        assert pair.gap[0] >= -depth - 1e-12
    assert calls < 20


@pytest.mark.parametrize("seed", range(20))
def test_along_a_face_the_time_to_touch_of_a_translation_is_exact(seed):
    rng = np.random.default_rng(seed)
    corner = rng.uniform(1.0, 2.0) + 0.3j * rng.uniform(-1, 1)
    kite = corner + np.array([0j, 0.3 - 0.2j, 0.5 + 0j, 0.3 + 0.2j])
    turn = np.exp(1j * rng.uniform(0, 6))
    speed = rng.uniform(0.1, 2.0)
    pair = pair_of(SQUARE, kite, body=(0, 1))
    pair.measure(np.zeros(2, dtype=complex), np.full(2, np.angle(turn)))
    velocity = turn * np.array([0j, speed * (-1 + 0.1j * rng.uniform(-1, 1))])
    h = pair.time_to_touch(velocity, np.zeros(2), np.zeros(2), 1e-3)
    assert h == pytest.approx((corner.real - 0.5 + 1e-3) / speed, abs=1e-9)


def test_what_moves_apart_never_touches():
    pair = pair_of(SQUARE, SQUARE, body=(0, 1))
    pair.measure(np.array([0j, 1 + 0j]), np.zeros(2))
    still = np.zeros(2)
    assert pair.time_to_touch(np.array([-1 + 0j, 0j]), still, still, 1e-3) > 1e6
    assert pair.time_to_touch(np.zeros(2, dtype=complex), still, still, 1e-3) > 1e6
    # one that comes back within 2 v / a
    bend = np.array([0.5, 0.0])
    h = pair.time_to_touch(np.array([-1 + 0j, 0j]), still, bend, 1e-3)
    assert 4.0 < h < 4.002


def test_pieces_that_are_deep_already_may_get_a_little_deeper():
    pair = pair_of(SQUARE, SQUARE)
    pair.measure(np.array([-0.9 + 0j]), np.zeros(1))
    h = pair.time_to_touch(np.array([1 + 0j]), np.zeros(1), np.zeros(1), 1e-3)
    assert h == pytest.approx(1e-3 / 64)


def test_a_turned_scene_has_the_same_gaps_and_turned_normals():
    _, _, pairs, position, angle = scattered(9, 200, 0.8)
    pairs.measure(position, angle)
    gap, normal = pairs.gap, pairs.normal
    turn = np.exp(1.1j)
    pairs.measure(turn * position + (3 - 4j), angle + 1.1)
    clear = gap > 1e-6
    assert pairs.gap == pytest.approx(gap, abs=1e-12)
    assert np.abs(pairs.normal - turn * normal)[clear].max() < 1e-6
