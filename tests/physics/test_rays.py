"""Rays and nearest points: pymunk's, of closed forms, and the same bits alone as in a team."""

from __future__ import annotations

from fractions import Fraction
from math import atan2, cos, inf, pi, sin, sqrt

import numpy as np
import pymunk
import pytest

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies.props import Ball, Box
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.physics.space import Space
from mars2d.sensors import LineCamera, RangeFinder, SonarRing
from mars2d.sensors.surroundings import NOTHING
from tests.cases import each_case
from tests.islands import pymunk_space

EXACT = 1e-9  # m

SHAPES = (
    Disc(0.4),
    Disc(0.6, center=(0.3, -0.1)),
    Polygon([(-0.3, -0.2), (0.4, -0.1), (0.2, 0.3), (-0.2, 0.25)]),
    Polygon([(0, 0), (0.6, 0), (0.6, 0.2), (0.2, 0.2), (0.2, 0.6), (0, 0.6)]),
    Compound([Disc(0.4, center=(0.1, 0.1)), Polygon([(0, -0.3), (0.5, 0), (0, 0.3)])]),
)

AT_ORIGIN = np.zeros((3, 1))


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
    """The same scene in pymunk, where body i is of the group i + 1."""
    return pymunk_space(bodies, poses.T, outlines)[0]


def assert_engines(space, found, start, angles, reach, ignore):
    """Rays are as long as pymunk says."""
    assert len(found) == len(angles)
    for length, angle in zip(found, angles, strict=True):
        end = start[0] + reach * cos(angle), start[1] + reach * sin(angle)
        hit = space.segment_query_first(tuple(start), end, 0.0, pymunk.ShapeFilter(ignore + 1))
        assert length == (inf if hit is None else pytest.approx(hit.alpha * reach, abs=EXACT))


def world_of(outlines=(), robots=(), props=()):
    """A world with a tiny robot 0 far away, which only lends its index, among other things."""
    asks = Robot(pose=(90, 90, 0), diameter=1e-3)
    addons = [Map(list(outlines))]
    return World(Scenario(robots=[asks, *robots], props=list(props), workspace=None, addons=addons))


def sight(world, start, angles):
    """The lengths (k,) of rays from a point at angles (k,), and the bodies that they hit."""
    pose = np.array([[start[0]], [start[1]], [0.0]])
    found = world.surroundings.sights(pose, angles, 100.0, [0])
    return found[0][0], found[1][0]


# -- pymunk's -----------------------------------------------------------------------------------


def test_fans_are_the_engines_rays():
    rng = np.random.default_rng(0)
    hits = starts_within = 0
    for _ in range(150):
        bodies, poses, _ = scene = some_scene(rng)
        fans, engine = fans_of(*scene), engines_space(*scene)
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
            assert_engines(engine, row, (x, y), angles, reach, own)
            alone = [fans.length((x, y), angle, reach, own) for angle in angles]
            assert alone == pytest.approx(row, abs=1e-12)
            each = np.vstack([np.tile([[x], [y]], beams), angles])
            assert alone == fans.distances(each, [0.0], reach, [own] * beams)[:, 0].tolist()
            hits += np.isfinite(row).sum()
            starts_within += (row == 0).all()
    assert hits > 5000
    assert starts_within > 20


def test_what_stands_before_a_point_and_what_is_nearest_to_it_is_the_engines():
    rng = np.random.default_rng(7)
    count = within = hidden = 0
    for _ in range(100):
        bodies, poses, _ = scene = some_scene(rng)
        space, engine = fans_of(*scene), engines_space(*scene)
        for point in [*rng.uniform(-4, 4, (5, 2)).tolist(), *(poses[:2].T + 0.01).tolist()]:
            own, limit = int(rng.integers(-1, len(bodies))), rng.uniform(0.1, 6)
            others = pymunk.ShapeFilter(own + 1)
            wanted = engine.point_query(tuple(point), limit, others)
            found = list(space.nearby(point, limit, own))
            assert sorted(found) == [
                pytest.approx(each, abs=EXACT) for each in sorted(info.point for info in wanted)
            ]
            nearest = min((info.distance for info in wanted), default=inf)
            assert space.distance(point, limit, own) == pytest.approx(nearest, abs=EXACT)
            count, within = count + len(found), within + (nearest < 0)
            ends = rng.uniform(-4, 4, (9, 2))
            met = [engine.segment_query_first(tuple(point), tuple(end), 0, others) for end in ends]
            behind = space.hidden(point, ends, NOTHING, own)
            assert behind.tolist() == [hit is not None for hit in met]
            hidden += behind.sum()
    assert count > 2000
    assert within > 100
    assert 0 < hidden < 9 * count


@each_case("physics", ["contact", "stop"])
def test_rays_meet_bodies_where_they_are_at_that_instant(physics):
    rng = np.random.default_rng(7)
    cells = [(k % 4 - 1.5, k // 4 - 1.5) for k in range(16)]
    robots = [
        Robot(pose=(*cells[k], rng.uniform(-3, 3)), shape=SHAPES[k % 5], center_offset=0.05)
        for k in range(12)
    ]
    props = [
        Ball(pose=(*cells[12], 0), diameter=0.3),
        Box(pose=(*cells[13], 0.5), length=0.4, width=0.3, velocity=(0.3, 0.2, 1.0)),
    ]
    scenario = Scenario(
        robots=robots, props=props, physics=physics, on_exit="wall", max_overlap=0.02,
        workspace=[(-2.2, -2.2), (2.2, -2.2), (2.2, 2.2), (-2.2, 2.2)],
    )  # fmt: skip
    world = World(scenario, seed=1)
    bodies = [body.shape.pieces for body in scenario.bodies]
    touched = 0
    for _ in range(30):
        world.step(np.vstack([rng.uniform(-1, 1, 12), rng.uniform(-4, 4, 12)]))
        touched += len(world.contacts)
        engine = engines_space(bodies, np.hstack([world.pose, world.prop_pose]), world.obstacles)
        angles = rng.uniform(-pi, pi, 30)
        for own, look in ((99, rng.uniform(-1.5, 1.5, (3, 1))), (3, world.pose[:, 3:4])):
            found = world.surroundings.sights(look * [[1], [1], [0]], angles, 6.0, [own])[0][0]
            assert_engines(engine, found, look[:2, 0], angles, 6.0, own)
    assert touched > 0


# -- closed forms -------------------------------------------------------------------------------


@each_case("angle", [0.0, 0.3, 1.0, pi / 2, 2.5])
@each_case("far", [0.5, 40.0])
def test_a_ray_exactly_along_a_wall_meets_its_end(angle, far):
    ahead = np.array([cos(angle), sin(angle)])
    left = np.array([-ahead[1], ahead[0]])
    start = np.array([0.4, -0.7])
    near, end = start + far * ahead, start + (far + 2) * ahead
    wall = Space([], [[tuple(near.tolist()), tuple(end.tolist())]])

    def seen(point, heading):
        return wall.length(tuple(point), heading, 100.0, -1)

    assert seen(start, angle) == pytest.approx(far, abs=EXACT)
    assert seen(end + 3 * ahead, angle + pi) == pytest.approx(3, abs=EXACT)
    assert seen(start, angle + pi) == inf
    for side in (-1e-6, 1e-6):  # beside the wall it goes on
        assert seen(start + side * left, angle) == inf


@each_case("radius", [1e-3, 0.15, 4.0])
@each_case("far", [0.5, 30.0])
def test_a_ray_that_grazes_a_disc_meets_it_and_one_beside_it_does_not(radius, far):
    distance = radius + far
    fans = fans_of([[([(0.0, 0.0)], radius)]], AT_ORIGIN, [])
    for bearing in (0.0, 0.7, 3.0):
        start = (-distance * cos(bearing), -distance * sin(bearing))
        for side in (-1, 1):
            edge = side * atan2(radius, sqrt(distance**2 - radius**2))
            inner, outer = (
                fans.length(start, bearing + edge + side * by, 100.0, -1) for by in (-1e-6, 1e-6)
            )
            assert outer == inf
            across = distance * sin(abs(edge) - 1e-6)
            wanted = distance * cos(abs(edge) - 1e-6) - sqrt(radius**2 - across**2)
            assert inner == pytest.approx(wanted, abs=EXACT)


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


# -- corners ------------------------------------------------------------------------------------

ROOMS = {
    "square": ([(0, 0), (10, 0), (10, 10), (0, 10)], (3.0, 4.0)),
    "turned": ([(1.1, 0.3), (7.7, 1.9), (9.3, 8.1), (0.7, 6.3)], (4.0, 4.0)),
    "concave": ([(0, 0), (6, 0), (6, 2), (3.1, 2.7), (6, 4.4), (6, 6), (0, 6)], (1.5, 3.0)),
    "far": (
        [(1e5 + x, 1e5 + y) for x, y in [(0, 0), (9.1, 0.3), (4.0, 3.0), (0.2, 8)]],
        (1e5 + 2,) * 2,
    ),
}


def beside(corner, start):
    """Three angles: straight at a corner, as rounded, and the next ones on both sides."""
    aimed = atan2(corner[1] - start[1], corner[0] - start[0])
    return [aimed, float(np.nextafter(aimed, 9)), float(np.nextafter(aimed, -9))]


@each_case("name", ROOMS)
@each_case("built", ["one outline", "walls that meet"])
def test_no_ray_leaves_a_closed_room(name, built):
    corners, middle = ROOMS[name]
    walls = [list(ends) for ends in zip(corners, [*corners[1:], corners[0]], strict=True)]
    room = Space([], [corners] if built == "one outline" else walls)
    rng = np.random.default_rng(0)
    for start in np.add(middle, rng.uniform(-0.5, 0.5, (90, 2))):
        angles = [*rng.uniform(-4, 4, 100), *(a for c in corners for a in beside(c, start))]
        look = np.array([[start[0]], [start[1]], [0.0]])
        assert np.isfinite(room.distances(look, angles, 40.0, [-1])).all()


def test_a_ray_aimed_exactly_at_a_bodys_corner_meets_it():
    kite = Polygon([(-0.3, -0.2), (0.4, -0.1), (0.2, 0.3), (-0.2, 0.25)])
    rng = np.random.default_rng(4)
    for _ in range(5):
        x, y, theta = pose = (*rng.uniform(-1, 1, 2), rng.uniform(-9, 9))
        world = world_of(robots=[Robot(pose=pose, shape=kite)])
        turn = np.array([[cos(theta), sin(theta)], [-sin(theta), cos(theta)]])
        corners = np.array(kite.outline) @ turn + (x, y)
        for corner in np.repeat(corners, 10, axis=0):
            out = corner - corners.mean(axis=0)
            start = corner + rng.uniform(0.5, 3) * out + rng.uniform(-0.1, 0.1, 2)
            found, bodies = sight(world, start, beside(corner, start))
            assert found == pytest.approx(np.hypot(*(corner - start)), abs=EXACT)
            assert bodies.tolist() == [1, 1, 1]


@each_case("eighth", range(8))
def test_a_ray_straight_at_the_corner_of_a_box_meets_it(eighth):
    angle, turned = eighth * pi / 4, 0.0 if eighth % 2 else pi / 4
    for far in np.arange(0.75, 6, 0.75):
        for half in (0.1, 0.15, 0.25):
            box = [(-half, -half), (half, -half), (half, half), (-half, half)]
            pose = np.array([[far * cos(angle)], [far * sin(angle)], [turned]])
            space = fans_of([[(box, 0.0)]], pose, [])
            found = space.distances(AT_ORIGIN, [angle], 9.0, [-1])
            assert found == pytest.approx(far - half * sqrt(2), abs=EXACT)
            assert space.hidden((0.0, 0.0), [[8 * cos(angle), 8 * sin(angle)]], NOTHING, -1).all()


# -- who is seen --------------------------------------------------------------------------------


def test_what_a_ray_hits_is_named():
    world = world_of(
        [[(0, 3), (1, 3)], [(-3, -1), (-3, 1)]],
        [Robot(pose=(2, 0, 0))],
        [Box(pose=(0, -2, 0), length=0.5, width=0.5)],
    )
    _, bodies = sight(world, (0, 0), np.array([0.0, 1.5, pi, -pi / 2, 0.7]))
    assert bodies.tolist() == [1, -1, -2, 2, NOTHING]


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
    assert fans.sight(AT_ORIGIN, [0.0], 5.0, [-1], NOTHING)[1].tolist() == [[0]]
    assert fans.sight(AT_ORIGIN, [0.0], 5.0, [0], NOTHING)[1].tolist() == [[1]]
    walls = Space([], [[(2, -1), (2, 1)], [(2, -1), (2, 1)]])
    assert walls.sight(AT_ORIGIN, [0.0], 5.0, [-1], NOTHING)[1].tolist() == [[-2]]


@each_case("shape", SHAPES)
@each_case("mount", [(0, 0, 0), (0.3, -0.4, 2.0)])
def test_a_robot_never_sees_itself_but_others(shape, mount):
    looks = [RangeFinder(beams=720, mount=mount)]
    robot = Robot(pose=(1, 1, 0.4), shape=shape, center_offset=0.1, sensors=looks)
    for others in ([], [Robot(pose=(4, 1, 0.4), diameter=0.2)]):
        world = World(Scenario(robots=[robot, *others], workspace=None))
        world.observe()
        assert np.isfinite(world.robots[0].sense.range_finder).any() == bool(others)


def test_a_robot_does_not_hide_its_own_centre():
    world = world_of(robots=[Robot(pose=(2, 0, 0)), Robot(pose=(4, 0, 0))])
    centres = np.array([(2.0, 0.0), (4.0, 0.0)])
    assert world.surroundings.hidden((0, 0), centres, [1, 2], 0).tolist() == [False, True]
    assert world.surroundings.hidden((0, 0), centres, NOTHING, 0).tolist() == [True, True]


# -- a fan alone is as one in a team ------------------------------------------------------------


@each_case("bearings", [np.linspace(-pi, pi, 180, endpoint=False), [0.3], [2, 1, 1]])
def test_a_fan_reads_the_same_bits_alone_and_in_any_order(bearings):
    rng = np.random.default_rng(5)
    for _ in range(30):
        bodies, poses, outlines = some_scene(rng)
        looks = rng.uniform(-4, 4, (3, 9)) * [[1], [1], [10]]
        fans, whose = fans_of(bodies, poses, outlines), rng.integers(-1, len(bodies), 9)
        distances, hit = fans.sight(looks, bearings, 5.0, whose, NOTHING)
        for some in (rng.permutation(9), *np.arange(9)[:, None]):
            again = fans.sight(looks[:, some], bearings, 5.0, whose[some], NOTHING)
            assert np.array_equal(again[0], distances[some])
            assert np.array_equal(again[1], hit[some])


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
    outlines = [[(0.6, -2), (0.6, 5)], [(5, 0), (6, 0.5), (5, 1)]]
    world = World(
        Scenario(
            robots=robots, props=[Box(pose=(2, 4, 0.3))], workspace=None, addons=[Map(outlines)]
        )
    )
    for _ in range(5):
        world.step(np.vstack([np.full(10, 0.3), rng.uniform(-1, 1, 10)]))
    world.observe()
    column = [getattr(robot.sense, sensor.key) for robot in world.robots]
    for robot, reading in zip(world.robots, column, strict=True):
        single = sensor.read(robot, world.surroundings, robot.rng)
        assert np.array_equal(single, reading, equal_nan=True)
    assert len({reading.tobytes() for reading in column}) > 7
