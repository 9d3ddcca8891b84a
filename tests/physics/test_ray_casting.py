"""Rays and nearest points are pymunk's, and a ray alone has the bits of one among many."""

from __future__ import annotations

from fractions import Fraction
from math import cos, inf, pi, sin

import numpy as np
import pymunk
import pytest

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies.props import Box
from mars2d.core.plane import edges_of
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.physics.space import Space
from mars2d.sensors import LineCamera, RangeFinder, SonarRing
from tests.cases import each_case

EXACT = 1e-9  # m
NOTHING = -99

SHAPES = (
    Disc(0.4),
    Disc(0.6, center=(0.3, -0.1)),
    Polygon([(-0.3, -0.2), (0.4, -0.1), (0.2, 0.3), (-0.2, 0.25)]),
    Polygon([(0, 0), (0.6, 0), (0.6, 0.2), (0.2, 0.2), (0.2, 0.6), (0, 0.6)]),
    Compound([Disc(0.4, center=(0.1, 0.1)), Polygon([(0, -0.3), (0.5, 0), (0, 0.3)])]),
)


def some_outline(rng, size):
    """A wall, a box, a star or a ring, either way round."""
    kind, angle = rng.integers(4), rng.uniform(0, 2 * pi)
    if kind == 0:
        points = [(size, 0), (-size, 0)]
    elif kind == 1:
        points = [(size, 0.3), (-size, 0.3), (-size, -0.3), (size, -0.3)]
    else:
        radii = np.resize([size, 0.4 * size] if kind == 2 else [size], 8)
        points = [(r * cos(k * pi / 4), r * sin(k * pi / 4)) for k, r in enumerate(radii)]
    turn = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
    placed = np.array(points) @ turn + rng.uniform(-3, 3, 2)
    return [tuple(map(float, point)) for point in placed][:: rng.choice([-1, 1])]


def some_scene(rng):
    """Bodies, their poses (3, N), and obstacles: anywhere, also one in another."""
    bodies = [SHAPES[k].pieces for k in rng.integers(len(SHAPES), size=rng.integers(1, 9))]
    poses = rng.uniform(-3, 3, (3, len(bodies)))
    return bodies, poses, [some_outline(rng, rng.uniform(0.1, 5)) for _ in range(rng.integers(7))]


def fans_of(bodies, poses, outlines):
    fans = Space(bodies, outlines)
    fans.place(np.vstack([poses, 0 * poses]).T.copy())
    return fans


def engines_space(bodies, poses, outlines):
    """The same scene in pymunk."""
    space = pymunk.Space()
    for i, (pieces, (x, y, theta)) in enumerate(zip(bodies, poses.T.tolist(), strict=True)):
        body = pymunk.Body(1.0, 1.0)
        body.position, body.angle = (x, y), theta
        space.add(body)
        for points, radius in pieces:
            disc = len(points) == 1
            shape = pymunk.Circle(body, radius, points[0]) if disc else pymunk.Poly(body, points)
            shape.filter = pymunk.ShapeFilter(i + 1)
            space.add(shape)
    for outline in outlines:
        space.add(*(pymunk.Segment(space.static_body, a, b, 0.0) for a, b in edges_of(outline)))

    return space


def engines(bodies, poses, outlines):
    """A function that returns the length of a ray by pymunk's method in the same scene."""
    space = engines_space(bodies, poses, outlines)

    def length(start, angle, reach, ignore):
        end = start[0] + reach * cos(angle), start[1] + reach * sin(angle)
        hit = space.segment_query_first(start, end, 0.0, pymunk.ShapeFilter(ignore + 1))
        return inf if hit is None else hit.alpha * reach

    return length


# -- what rays meet -----------------------------------------------------------------------------


def test_fans_are_the_engines_rays():
    rng = np.random.default_rng(0)
    hits = starts_within = 0
    for _ in range(150):
        bodies, poses, _ = scene = some_scene(rng)
        fans, length = fans_of(*scene), engines(*scene)
        count, beams = int(rng.integers(1, 8)), int(rng.integers(1, 60))
        looks = rng.uniform(-4, 4, (3, count))
        whose = rng.integers(len(bodies), size=count)
        looks[:2, 0] = poses[:2, whose[0]]  # from within its own body
        looks[:2, -1] = poses[:2, 0]  # perhaps from within another one
        bearings = np.linspace(-rng.uniform(0.1, pi), rng.uniform(0.1, pi), beams)
        if rng.random() < 0.3:
            bearings = rng.uniform(-9, 9, beams)
        reach = rng.uniform(0.5, 9)
        found = fans.distances(looks, bearings, reach, whose)
        for row, (x, y, theta), own in zip(found, looks.T.tolist(), whose.tolist(), strict=True):
            angles = (theta + bearings).tolist()
            wanted = np.array([length((x, y), angle, reach, own) for angle in angles])
            assert np.array_equal(np.isfinite(row), np.isfinite(wanted))
            hit = np.isfinite(row)
            assert np.abs(row[hit] - wanted[hit]).max(initial=0) < EXACT
            alone = [fans.length((x, y), angle, reach, own) for angle in angles]
            assert np.abs(row[hit] - np.array(alone)[hit]).max(initial=0) < 1e-12
            assert (
                alone
                == fans.distances(
                    np.vstack([np.tile([[x], [y]], beams), angles]), [0.0], reach, [own] * beams
                )[:, 0].tolist()
            )
            hits += hit.sum()
            starts_within += (row == 0).all()
    assert hits > 5000
    assert starts_within > 20


def test_nearest_points_are_the_engines():
    rng = np.random.default_rng(7)
    count = within = 0
    for _ in range(100):
        bodies, poses, _ = scene = some_scene(rng)
        space, engine = fans_of(*scene), engines_space(*scene)
        for point in [*rng.uniform(-4, 4, (5, 2)).tolist(), *(poses[:2].T + 0.01).tolist()]:
            own, limit = int(rng.integers(-1, len(bodies))), rng.uniform(0.1, 6)
            wanted = engine.point_query(tuple(point), limit, pymunk.ShapeFilter(own + 1))
            found = list(space.nearby(point, limit, own))
            assert sorted(found) == [
                pytest.approx(each, abs=EXACT) for each in sorted(info.point for info in wanted)
            ]
            nearest = min((info.distance for info in wanted), default=inf)
            assert space.distance(point, limit, own) == pytest.approx(nearest, abs=EXACT)
            count, within = count + len(found), within + (nearest < 0)
    assert count > 2000
    assert within > 100


def test_a_ray_hits_the_body_that_alone_is_as_far():
    rng = np.random.default_rng(1)
    for _ in range(30):
        bodies, poses, outlines = scene = some_scene(rng)
        fans = fans_of(*scene)
        look, bearings = rng.uniform(-4, 4, (3, 1)), np.linspace(-pi, pi, 50)
        distances, hit = fans.sight(look, bearings, 6.0, [-1], NOTHING)
        assert np.array_equal(distances, fans.distances(look, bearings, 6.0, [-1]))
        assert np.array_equal(hit == NOTHING, np.isinf(distances))
        for number in np.unique(hit[hit != NOTHING]).tolist():
            if number < 0:
                alone = Space([], [outlines[-1 - number]])
            else:
                alone = fans_of([bodies[number]], poses[:, number : number + 1], [])
            mine = alone.distances(look, bearings, 6.0, [-1])
            assert (mine[hit == number] == distances[hit == number]).all()
            assert (mine >= distances).all()


def test_of_bodies_equally_far_the_lowest_number_is_hit():
    disc = [([(0.0, 0.0)], 0.5)]
    fans = fans_of([disc, disc, disc], np.array([[2.0] * 3, [0.0] * 3, [0.0] * 3]), [])
    look = np.zeros((3, 1))
    assert fans.sight(look, [0.0], 5.0, [-1], NOTHING)[1].tolist() == [[0]]
    assert fans.sight(look, [0.0], 5.0, [0], NOTHING)[1].tolist() == [[1]]
    walls = Space([], [[(2, -1), (2, 1)], [(2, -1), (2, 1)]])
    assert walls.sight(look, [0.0], 5.0, [-1], NOTHING)[1].tolist() == [[-2]]


def test_a_ray_that_grazes_an_edge_is_as_long_as_exact_arithmetic_says():
    rng = np.random.default_rng(3)
    looked_at = 0
    for steep in (1e-1, 1e-2, 1e-3, 1e-4, 3e-5):
        for _ in range(100):
            x, y, along = rng.uniform(-5, 5, 3)
            ahead = np.array([cos(along), sin(along)])
            a = (x, y) + rng.uniform(0.1, 1) * ahead + rng.uniform(0, steep) * ahead[::-1] * (-1, 1)
            b = a + rng.uniform(0.5, 30) * ahead + steep * ahead[::-1] * (1, -1)
            ends = [tuple(map(float, a)), tuple(map(float, b))]
            target = a + rng.uniform(0.01, 0.99) * (b - a)
            bearing = float(np.arctan2(target[1] - y, target[0] - x))
            found = Space([], [ends]).distances(np.array([[x], [y], [0.0]]), [bearing], 99.0, [-1])
            c, s = Fraction(float(np.cos(bearing))), Fraction(float(np.sin(bearing)))
            ax, ay = (
                Fraction(p) - Fraction(float(q)) for p, q in zip(ends[0], (x, y), strict=True)
            )
            ex, ey = (Fraction(q) - Fraction(p) for p, q in zip(*ends, strict=True))
            turn = c * ey - s * ex
            if abs(turn) < 3e-6 * np.hypot(*(b - a)):  # where 1e-16 m aside are 1e-10 m ahead
                continue
            assert abs(Fraction(float(found[0, 0])) - (ax * ey - ay * ex) / turn) < EXACT
            looked_at += 1
    assert looked_at > 400


def test_a_ray_along_the_long_side_of_a_box_that_just_touches_it_goes_to_its_corner():
    box = [(1.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0)]
    for turn in (1, -1):
        fans = Space([], [box[::turn]])
        looks = np.array([[0.0, 6, 2, 2, 4], [0.0, 1, 0, 0.5, 1], [0.0, pi, 0, 0, 0]])
        found = fans.distances(looks, [0.0, pi], 9.0, [-1] * 5)
        assert found[0].tolist() == [1.0, inf]
        assert found[1] == pytest.approx([2.0, inf])
        assert found[2].tolist() == [0.0, 0.0]  # from a point of the outline itself
        assert found[3].tolist() == [2.0, 1.0]  # from within
        assert found[4].tolist() == [0.0, 0.0]  # from a corner


def test_there_may_be_nothing_to_see_and_no_ray_to_see_it():
    look = np.zeros((3, 2))
    assert Space([], []).distances(look, [0.0, 1.0], 5.0, [-1, -1]).tolist() == [[inf] * 2] * 2
    assert Space([], [[(1, -1), (1, 1)]]).distances(look, [], 5.0, [-1, -1]).shape == (2, 0)
    assert Space([], [[(1, -1), (1, 1)]]).distances(look[:, :0], [0.0], 5.0, []).shape == (0, 1)


@each_case("far", [1e3, 1e5])
def test_far_from_the_origin_no_ray_slips_through_a_corner(far):
    rng = np.random.default_rng(0)
    room = [(far + x, far + y) for x, y in [(0, 0), (9.1, 0.3), (8.7, 7.9), (4.0, 3.0), (0.2, 8)]]
    fans = Space([], [room])
    for start in rng.uniform(1, 2.5, (200, 2)) + far:
        aimed = [np.arctan2(y - start[1], x - start[0]) for x, y in room]
        bearings = np.concatenate([np.nextafter(aimed, side) for side in (-9, 9)] + [aimed])
        look = np.array([[start[0]], [start[1]], [0.0]])
        assert np.isfinite(fans.distances(look, bearings, 99.0, [-1])).all()


# -- a fan alone is as one in a team ------------------------------------------------------------


def team(rng, size):
    """Fans in some scene, and as many looks."""
    bodies, poses, outlines = some_scene(rng)
    looks = rng.uniform(-4, 4, (3, size))
    looks[2] *= 10
    return fans_of(bodies, poses, outlines), looks, rng.integers(-1, len(bodies), size)


@each_case("bearings", [np.linspace(-pi, pi, 180, endpoint=False), [0.3], [2, 1, 1]])
def test_a_fan_reads_the_same_bits_alone_and_in_any_order(bearings):
    rng = np.random.default_rng(5)
    for _ in range(30):
        fans, looks, whose = team(rng, 9)
        distances, bodies = fans.sight(looks, bearings, 5.0, whose, NOTHING)
        order = rng.permutation(9)
        again = fans.sight(looks[:, order], bearings, 5.0, whose[order], NOTHING)
        assert np.array_equal(again[0], distances[order])
        assert np.array_equal(again[1], bodies[order])
        for i in range(9):
            alone = fans.sight(looks[:, i : i + 1], bearings, 5.0, whose[i : i + 1], NOTHING)
            assert np.array_equal(alone[0][0], distances[i])
            assert np.array_equal(alone[1][0], bodies[i])


def test_a_fan_reads_the_same_bits_in_a_big_team():
    rng = np.random.default_rng(7)
    outlines = [
        [(x, y), (x + 0.4, y), (x + 0.3, y + 0.3)] for x, y in rng.uniform(-30, 30, (400, 2))
    ]
    discs = [[([(0.0, 0.0)], 0.15)]] * 400
    looks = rng.uniform(-30, 30, (3, 400))
    fans = fans_of(discs, looks, outlines)
    everybody = np.arange(400)
    together = fans.distances(looks, np.linspace(-1, 1, 40), 5.0, everybody)
    for i in range(0, 400, 40):
        few = slice(i, i + 40)
        some = fans.distances(looks[:, few], np.linspace(-1, 1, 40), 5.0, everybody[few])
        assert np.array_equal(some, together[few])
    assert np.isfinite(together).mean() > 0.3


@each_case(
    "sensor",
    [
        RangeFinder(beams=90, range=3.0),
        RangeFinder(beams=31, field_of_view=2.0, mount=(0.1, 0.05, 0.3)),
        LineCamera(pixels=40, mount=(0.1, 0, 0)),
        SonarRing(),
    ],
)
def test_a_sensor_reads_the_same_bits_by_itself_and_with_its_team(sensor):
    rng = np.random.default_rng(8)
    robots = [
        Robot(pose=(1.2 * (k % 4), 1.2 * (k // 4), rng.uniform(-9, 9)), sensors=[sensor])
        for k in range(10)
    ]
    world = World(
        Scenario(
            robots=robots, props=[Box(pose=(2, 4, 0.3))], workspace=None,
            addons=[Map([[(0.6, -2), (0.6, 5)], [(5, 0), (6, 0.5), (5, 1)]])],
        )
    )  # fmt: skip
    for _ in range(5):
        world.step(np.vstack([np.full(10, 0.3), rng.uniform(-1, 1, 10)]))
    world.observe()
    column = [getattr(robot.sense, sensor.key) for robot in world.robots]
    for robot, reading in zip(world.robots, column, strict=True):
        single = sensor.read(robot, world.surroundings, robot.rng)
        assert np.array_equal(single, reading, equal_nan=True)
    assert len({reading.tobytes() for reading in column}) > 7
