"""Rays against closed-form geometry: discs, polygons, walls, ends, corners, bodies on the move."""

from __future__ import annotations

from math import atan2, cos, inf, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies.props import Ball, Box
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.sensors import RangeFinder
from mars2d.sensors.surroundings import NOTHING
from tests.cases import each_case

EXACT = 1e-9  # m

# -- an implementation of its own: the first point of a ray in the closed form ------------------


def sight(world, start, angles, length, ignore):
    """Return the lengths (k,) of rays from a point at angles (k,), and the bodies that they hit."""
    pose = np.array([[start[0]], [start[1]], [0.0]])
    found = world.surroundings.sights(pose, angles, length, [ignore])
    return found[0][0], found[1][0]


def rays(world, start, angles, length, ignore):
    return sight(world, start, angles, length, ignore)[0]


def disc(start, way, center, radius):
    """How far unit vectors `way` (k, 2) go from `start` to a disc; 0 from within."""
    to = np.subtract(center, start)
    across = way[:, 0] * to[1] - way[:, 1] * to[0]
    along = way @ to
    if np.hypot(*to) <= radius:
        return np.zeros(len(way))
    half = np.sqrt(np.maximum(radius**2 - across**2, 0))
    return np.where((np.abs(across) <= radius) & (along > 0), along - half, inf)


def segment(start, way, a, b):
    """How far they go to a segment, which is met from either side, but not by what runs along."""
    to, edge = np.subtract(a, start), np.subtract(b, a)
    turn = way[:, 0] * edge[1] - way[:, 1] * edge[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (to[0] * edge[1] - to[1] * edge[0]) / turn
        share = (to[0] * way[:, 1] - to[1] * way[:, 0]) / turn
    return np.where((turn != 0) & (along >= 0) & (share >= 0) & (share <= 1), along, inf)


def ring(start, way, points):
    """How far they go to the edges of a closed outline, from outside or inside."""
    edges = zip(points, np.roll(points, -1, axis=0), strict=True)
    return np.min([segment(start, way, a, b) for a, b in edges], axis=0)


def solid(start, way, points):
    """How far they go to a filled polygon; 0 from within."""
    odd = False
    for (ax, ay), (bx, by) in zip(points, np.roll(points, -1, axis=0), strict=True):
        if (ay > start[1]) != (by > start[1]):
            odd ^= start[0] < ax + (start[1] - ay) * (bx - ax) / (by - ay)
    return np.zeros(len(way)) if odd else ring(start, way, points)


def placed(points, pose):
    x, y, theta = pose
    turn = np.array([[cos(theta), sin(theta)], [-sin(theta), cos(theta)]])
    return np.asarray(points, dtype=float) @ turn + (x, y)


def body(start, way, shape, pose):
    """How far they go to a disc, polygon or compound at a pose."""
    if isinstance(shape, Disc):
        return disc(start, way, placed([shape.center], pose)[0], shape.radius)
    if isinstance(shape, Polygon):
        return solid(start, way, placed(shape.outline, pose))
    return np.min([body(start, way, part, pose) for part in shape.parts], axis=0)


def outline(start, way, points):
    """How far they go to an obstacle: a wall of two vertices, or a polygon's edges."""
    return segment(start, way, *points) if len(points) == 2 else ring(start, way, np.array(points))


def chassis(robot):
    """The shape of a robot about its centre of rotation."""
    shape = robot.shape or Disc(robot.diameter)
    return shape.moved(-robot.center_offset, 0)


def expected(world, start, angles, reach, ignore):
    """How far rays go in a world, in the closed form."""
    way = np.column_stack([np.cos(angles), np.sin(angles)])
    bodies = [chassis(robot) for robot in world.scenario.robots]
    bodies += [prop.shape for prop in world.scenario.props]
    poses = np.hstack([world.pose, world.prop_pose]).T
    found = [
        body(start, way, shape, pose)
        for i, (shape, pose) in enumerate(zip(bodies, poses, strict=True))
        if i != ignore
    ]
    found += [outline(start, way, points) for points in world.obstacles]
    nearest = np.min([np.full(len(way), inf), *found], axis=0)
    return np.where(nearest <= reach, nearest, inf)


def doubtful(world, start, angles, reach):
    """Which rays pass so near to an edge or corner that rounding decides what they meet."""
    way = np.column_stack([np.cos(angles), np.sin(angles)])
    points, radii = [], []
    shapes = [(chassis(r), p) for r, p in zip(world.scenario.robots, world.pose.T, strict=True)]
    shapes += [(b.shape, p) for b, p in zip(world.scenario.props, world.prop_pose.T, strict=True)]
    while shapes:
        shape, pose = shapes.pop()
        if isinstance(shape, Compound):
            shapes += [(part, pose) for part in shape.parts]
            continue
        round_ = isinstance(shape, Disc)
        corners = placed([shape.center] if round_ else shape.outline, pose)
        points += corners.tolist()
        radii += [shape.radius if round_ else 0.0] * len(corners)
    for wall in world.obstacles:
        points += list(wall)
        radii += [0.0] * len(wall)
    to = np.array(points) - start
    across = np.abs(np.outer(way[:, 0], to[:, 1]) - np.outer(way[:, 1], to[:, 0]))
    return (np.abs(across - radii) < EXACT).any(axis=1)


def assert_exact(world, start, angles, reach=6.0, ignore=0):
    """Rays are what the closed form says, but for those that rounding decides."""
    found = rays(world, tuple(start), angles, reach, ignore)
    wanted = expected(world, start, angles, reach, ignore)
    sure = ~doubtful(world, start, angles, reach)
    sure &= ~(np.abs(wanted - reach) < EXACT)
    assert sure.mean() > 0.9
    assert np.array_equal(np.isfinite(found[sure]), np.isfinite(wanted[sure]))
    hit = sure & np.isfinite(wanted)
    assert np.abs(found[hit] - wanted[hit]).max(initial=0) < EXACT
    return found


def world_of(outlines=(), robots=(), props=(), **fields):
    """A world with a tiny robot 0 far away, which only lends its index, among other things."""
    asks = Robot(pose=(90, 90, 0), diameter=1e-3)
    fields = {"workspace": None, "addons": [Map(list(outlines))]} | fields
    return World(Scenario(robots=[asks, *robots], props=list(props), **fields))


def star(rng, spikes, inner, outer):
    """A polygon round the origin, convex if both radii are equal."""
    radii = np.resize([outer, inner], spikes)
    angles = (np.arange(spikes) + rng.uniform(-0.2, 0.2, spikes)) * 2 * pi / spikes
    return np.column_stack([radii * np.cos(angles), radii * np.sin(angles)]).tolist()


def some_shape(rng, kind):
    if kind == "disc":
        return Disc(rng.uniform(0.3, 1.2))
    if kind == "convex":
        return Polygon(star(rng, int(rng.integers(3, 8)), 0.7, 0.7))
    if kind == "concave":
        return Polygon(star(rng, 2 * int(rng.integers(3, 6)), 0.3, 0.7))
    square = Polygon([(0, -0.2), (0.6, -0.2), (0.6, 0.25), (0, 0.25)])
    return Compound([square, Disc(0.5, center=(-0.2, 0.1)), Polygon(star(rng, 6, 0.2, 0.5))])


def some_obstacle(rng, kind, center):
    angle, half = rng.uniform(0, pi), rng.uniform(0.2, 0.8)
    ahead = np.array([cos(angle), sin(angle)])
    left = np.array([-ahead[1], ahead[0]])
    if kind == "wall":
        points = [half * ahead, -half * ahead]
    elif kind == "thick wall":
        thick = rng.uniform(0.005, 0.15)
        points = [
            a * half * ahead + b * thick * left for a, b in [(1, 1), (-1, 1), (-1, -1), (1, -1)]
        ]
    else:
        points = star(rng, 8, 0.35, 0.8)
    return [tuple(map(float, np.add(point, center))) for point in points]


BODIES = ("disc", "convex", "concave", "compound")
OBSTACLES = ("wall", "thick wall", "room")


@pytest.mark.slow
@given(
    kinds=st.lists(st.sampled_from(["nothing", *BODIES, *OBSTACLES]), min_size=9, max_size=9),
    seed=st.integers(0, 2**32 - 1),
)
@settings(max_examples=15)
def test_rays_are_those_of_closed_form_geometry(kinds, seed):
    rng = np.random.default_rng(seed)
    cells = [(2.0 * (k % 3 - 1), 2.0 * (k // 3 - 1)) for k in range(9)]
    robots, outlines = [], []
    for kind, center in zip(kinds, cells, strict=True):
        if kind in BODIES:
            shape, offset = some_shape(rng, kind), rng.choice([0.0, 0.1])
            robots.append(
                Robot(pose=(*center, rng.uniform(-9, 9)), shape=shape, center_offset=offset)
            )
        elif kind in OBSTACLES:
            outlines.append(some_obstacle(rng, kind, center))
    world = world_of(outlines, robots)
    for start in rng.uniform(-3, 3, (8, 2)):
        assert_exact(world, start, rng.uniform(-10, 10, 60), rng.uniform(0.5, 6))
    for i in range(1, len(robots) + 1):  # from where they are themselves
        assert_exact(world, world.pose[:2, i], rng.uniform(-10, 10, 60), 5.0, ignore=i)


# -- single cases ------------------------------------------------------------------------------


def test_a_ray_is_as_long_as_it_is_to_the_nearest_thing_in_its_way():
    world = world_of([[(3, -1), (3, 1)]], [Robot(pose=(2, 0, 0), diameter=0.5)])
    found = rays(world, (0, 0), np.array([0.0, pi, 0.3]), 5.0, 0)
    assert found.tolist() == [1.75, inf, pytest.approx(3 / cos(0.3), abs=EXACT)]


@each_case("angle", [0.0, 0.3, 1.0, pi / 2, 2.5])
@each_case("far", [0.5, 40.0])
def test_a_ray_exactly_along_a_wall_meets_its_end(angle, far):
    ahead = np.array([cos(angle), sin(angle)])
    left = np.array([-ahead[1], ahead[0]])
    start = np.array([0.4, -0.7])
    near, end = start + far * ahead, start + (far + 2) * ahead
    world = world_of([[tuple(near), tuple(end)]])

    def seen(point, heading):
        return rays(world, tuple(point), np.array([heading]), 100.0, 0)[0]

    assert seen(start, angle) == pytest.approx(far, abs=EXACT)
    assert seen(end + 3 * ahead, angle + pi) == pytest.approx(3, abs=EXACT)
    assert seen(start, angle + pi) == inf
    for side in (-1e-6, 1e-6):  # beside the wall it goes on
        assert seen(start + side * left, angle) == inf


@each_case("thickness", [1e-3, 0.1, 1.0])
def test_a_thick_walls_end_is_met_by_rays_from_within_its_thickness(thickness):
    r = thickness / 2
    wall = [(0, -r), (4, -r), (4, r), (0, r)]
    world = world_of([wall])
    for y in np.linspace(-0.999, 0.999, 7) * r:
        for gap in (1e-6, 1e-3, r / 2, 3.0):
            found = rays(world, (-gap, y), np.array([0.0, pi]), 6.0, 0)
            assert found[0] == pytest.approx(gap, abs=EXACT)
            assert found[1] == inf
            assert_exact(world, (-gap, y), np.linspace(-1.5, 1.5, 40))
            assert_exact(world, (4 + gap, y), pi + np.linspace(-1.5, 1.5, 40))


@each_case("radius", [1e-3, 0.15, 4.0])
@each_case("far", [0.5, 30.0])
def test_a_ray_that_grazes_a_disc_meets_it_and_one_beside_it_does_not(radius, far):
    distance = radius + far
    world = world_of(robots=[Robot(pose=(0, 0, 0), diameter=2 * radius)])
    for bearing in (0.0, 0.7, 3.0):
        start = (-distance * cos(bearing), -distance * sin(bearing))
        tangent = sqrt(distance**2 - radius**2)
        for side in (-1, 1):
            edge = side * atan2(radius, tangent)
            angles = bearing + edge + np.array([-1e-6, 1e-6]) * side
            inner, outer = rays(world, start, angles, 100.0, 0)
            assert outer == inf
            across = distance * sin(abs(edge) - 1e-6)
            wanted = distance * cos(abs(edge) - 1e-6) - sqrt(radius**2 - across**2)
            assert inner == pytest.approx(wanted, abs=EXACT)


@each_case("kind", BODIES)
def test_a_ray_that_starts_inside_another_robot_goes_no_way_at_all(kind):
    rng = np.random.default_rng(3)
    world = world_of(robots=[Robot(pose=(1, 2, 0.5), shape=some_shape(rng, kind))])
    x, y = placed([(0.01, 0.02)], (1, 2, 0.5))[0]
    angles = np.linspace(-pi, pi, 30)
    assert rays(world, (x, y), angles, 5.0, 0).tolist() == [0.0] * 30
    distances, bodies = sight(world, (x, y), angles, 5.0, 0)
    assert distances.tolist() == [0.0] * 30
    assert bodies.tolist() == [1] * 30


def test_what_a_ray_hits_is_named():
    world = world_of(
        [[(0, 3), (1, 3)], [(-3, -1), (-3, 1)]],
        [Robot(pose=(2, 0, 0))],
        [Box(pose=(0, -2, 0), length=0.5, width=0.5)],
    )
    angles = np.array([0.0, 1.5, pi, -pi / 2, 0.7])
    _, bodies = sight(world, (0, 0), angles, 5.0, 0)
    assert bodies.tolist() == [1, -1, -2, 2, NOTHING]


# -- corners ------------------------------------------------------------------------------------

ROOMS = {
    "square": ([(0, 0), (10, 0), (10, 10), (0, 10)], (3.0, 4.0)),
    "turned": ([(1.1, 0.3), (7.7, 1.9), (9.3, 8.1), (0.7, 6.3)], (4.0, 4.0)),
    "concave": ([(0, 0), (6, 0), (6, 2), (3.1, 2.7), (6, 4.4), (6, 6), (0, 6)], (1.5, 3.0)),
    "star": (star(np.random.default_rng(1), 10, 1.2, 3.0), (0.0, 0.0)),
}


@each_case("name", ROOMS)
@each_case("built", ["one outline", "walls that meet", "workspace"])
def test_no_ray_leaves_a_closed_room(name, built):
    corners, middle = ROOMS[name]
    corners = [(float(x), float(y)) for x, y in corners]
    walls = [list(ends) for ends in zip(corners, [*corners[1:], corners[0]], strict=True)]
    if built == "workspace":
        robot = Robot(pose=(*middle, 0), diameter=1e-3)
        world = World(Scenario(robots=[robot], workspace=corners, on_exit="wall"))
    else:
        world = world_of([corners] if built == "one outline" else walls)
    rng = np.random.default_rng(0)
    count = escaped = 0
    while count < 10_000:
        start = np.add(middle, rng.uniform(-0.5, 0.5, 2))
        aimed = np.array([atan2(y - start[1], x - start[0]) for x, y in corners])
        angles = [aimed, np.nextafter(aimed, 9), np.nextafter(aimed, -9), rng.uniform(-4, 4, 100)]
        found = rays(world, tuple(start), np.concatenate(angles), 40.0, 0)
        count += len(found)
        escaped += np.isinf(found).sum()
    assert escaped == 0


def test_a_ray_aimed_exactly_at_a_bodys_corner_meets_it():
    shape = Polygon([(-0.3, -0.2), (0.4, -0.1), (0.2, 0.3), (-0.2, 0.25)])
    rng = np.random.default_rng(4)
    for _ in range(5):
        pose = (*rng.uniform(-1, 1, 2), rng.uniform(-9, 9))
        world = world_of(robots=[Robot(pose=pose, shape=shape)])
        corners = placed(shape.outline, pose)
        middle = corners.mean(axis=0)
        for corner in np.repeat(corners, 10, axis=0):
            out = corner - middle
            start = corner + rng.uniform(0.5, 3) * out + rng.uniform(-0.1, 0.1, 2)
            aimed = atan2(corner[1] - start[1], corner[0] - start[0])
            angles = np.array([aimed, np.nextafter(aimed, 9), np.nextafter(aimed, -9)])
            found, bodies = sight(world, tuple(start), angles, 9.0, 0)
            assert found == pytest.approx(np.hypot(*(corner - start)), abs=EXACT)
            assert bodies.tolist() == [1, 1, 1]


@each_case("eighth", range(8))
def test_a_ray_straight_at_the_corner_of_a_box_meets_it(eighth):
    angle = eighth * pi / 4
    for far in np.arange(0.75, 6, 0.75):
        for size in (0.2, 0.3, 0.5):
            turned = 0.0 if eighth % 2 else pi / 4
            box = Box(pose=(far * cos(angle), far * sin(angle), turned), length=size, width=size)
            world = world_of(props=[box])
            found = rays(world, (0.0, 0.0), np.array([angle]), 9.0, 0)
            assert found.tolist() == [pytest.approx(far - size / sqrt(2), abs=EXACT)]
            behind = np.array([[8 * cos(angle), 8 * sin(angle)]])
            assert world.surroundings.hidden((0.0, 0.0), behind, NOTHING, 0).all()


# -- a robot's own body -------------------------------------------------------------------------


@each_case("kind", BODIES)
@each_case("offset", [0.0, 0.1])
@each_case("mount", [(0, 0, 0), (0.3, -0.4, 2.0)])
def test_a_robot_never_sees_itself(kind, offset, mount):
    shape = some_shape(np.random.default_rng(2), kind)
    robot = Robot(
        pose=(1, 1, 0.4), shape=shape, center_offset=offset,
        sensors=[RangeFinder(beams=720, mount=mount)],
    )  # fmt: skip
    world = World(Scenario(robots=[robot]))
    world.observe()
    assert np.isinf(world.robots[0].sense.range_finder).all()
    both = World(Scenario(robots=[robot, Robot(pose=(4, 1, 0.4), diameter=0.2)]))
    both.observe()
    assert np.isfinite(both.robots[0].sense.range_finder).any()  # but it does see the other


# -- bodies that have moved ---------------------------------------------------------------------


@each_case("physics", ["contact", "stop"])
def test_rays_meet_bodies_where_they_are_at_that_instant(physics):
    rng = np.random.default_rng(7)
    cells = [(0.75 * (k % 4) - 1.1, 0.75 * (k // 4) - 1.1) for k in range(16)]
    wedge = Polygon([(-0.25, -0.2), (0.35, 0), (-0.25, 0.2)])
    nose = Polygon([(0, -0.1), (0.3, -0.1), (0.3, 0.1), (0, 0.1)])
    shapes = [Disc(0.4), wedge, Compound([Disc(0.3), nose])]
    robots = [
        Robot(pose=(*cells[k], rng.uniform(-3, 3)), shape=shapes[k % 3], center_offset=0.05)
        for k in range(12)
    ]
    props = [
        Ball(pose=(*cells[12], 0), diameter=0.3),
        Box(pose=(*cells[13], 0.5), length=0.4, width=0.3, velocity=(0.3, 0.2, 1.0)),
        Box(pose=(*cells[14], 1), length=0.3, width=0.5),
    ]
    scenario = Scenario(
        robots=robots, props=props, physics=physics, on_exit="wall",
        workspace=[(-1.6, -1.6), (1.6, -1.6), (1.6, 1.6), (-1.6, 1.6)],
    )  # fmt: skip
    world = World(scenario, seed=1)
    touched = 0
    for _ in range(30):
        world.step(np.vstack([rng.uniform(-1, 1, 12), rng.uniform(-4, 4, 12)]))
        touched += len(world.contacts)
        assert_exact(world, rng.uniform(-1.5, 1.5, 2), rng.uniform(-pi, pi, 30), 6.0, ignore=99)
        assert_exact(world, world.pose[:2, 3], rng.uniform(-pi, pi, 30), 6.0, ignore=3)
    assert touched > 0


# -- what stands between, and the public way ----------------------------------------------------


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=15)
def test_what_is_hidden_has_something_before_it(seed):
    rng = np.random.default_rng(seed)
    outlines = [some_obstacle(rng, kind, center) for kind, center in
                zip(OBSTACLES, [(-2, 0), (2, 0), (0, 2)], strict=True)]  # fmt: skip
    world = world_of(outlines, [Robot(pose=(0, -1, 0), diameter=0.6)])
    start, points = rng.uniform(-3, 3, 2), rng.uniform(-3, 3, (40, 2))
    found = world.surroundings.hidden(tuple(start), points, NOTHING, 0)
    angles = np.array([atan2(y - start[1], x - start[0]) for x, y in points])
    apart = np.hypot(*(points - start).T)
    free = np.array([expected(world, start, angles[k : k + 1], apart[k], 0)[0] for k in range(40)])
    sure = ~doubtful(world, start, angles, 9.0)
    assert np.array_equal(found[sure], np.isfinite(free[sure]))


def test_a_robot_does_not_hide_its_own_centre():
    world = world_of(robots=[Robot(pose=(2, 0, 0)), Robot(pose=(4, 0, 0))])
    centres = np.array([(2.0, 0.0), (4.0, 0.0)])
    assert world.surroundings.hidden((0, 0), centres, [1, 2], 0).tolist() == [False, True]
    assert world.surroundings.hidden((0, 0), centres, NOTHING, 0).tolist() == [True, True]
