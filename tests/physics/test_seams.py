"""Seams of walls are not felt: what slides over them goes on as along one straight wall."""

from __future__ import annotations

from itertools import pairwise
from math import cos, hypot, pi, radians, sin

import numpy as np
import pytest

from mars2d import Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies.props import Ball, Box, Prop, Puck, Solid
from mars2d.geometry.shapes import Polygon
from mars2d.physics.walls import walls_of
from tests.worlds import drive, endless

FAR = Robot(pose=(0, 60, 0))
HEXAGON = Polygon([(0.15 * cos(k * pi / 3), 0.15 * sin(k * pi / 3)) for k in range(6)])
SQUARE = Polygon([(-0.15, -0.15), (0.15, -0.15), (0.15, 0.15), (-0.15, 0.15)])

Point = tuple[float, float]


def block(left: float, right: float, depth: float = 1.0, top: float = 0.0) -> list[Point]:
    """A block below y = top, counter-clockwise."""
    return [(left, top - depth), (right, top - depth), (right, top), (left, top)]


CUTS = [-9.0, *(-1.3 + 0.23 * k for k in range(12)), 9.0]

SEAMS = {
    "three points": Map(walls=[[(-9, 0), (0, 0), (9, 0)]]),
    "two walls": Map([[(-9, 0), (0.1, 0)], [(0.1, 0), (9, 0)]]),
    "two walls that face each other": Map([[(-9, 0), (0.1, 0)], [(9, 0), (0.1, 0)]]),
    "two walls that overlap": Map([[(-9, 0), (0.3, 0)], [(-0.2, 0), (9, 0)]]),
    "two walls that miss each other by 1e-9": Map([[(-9, 0), (0, 1e-9)], [(1e-9, 0), (9, 0)]]),
    "forty pieces": Map(walls=[[(x, 0) for x in np.linspace(-9, 9, 41)]]),
    "blocks": Map([block(-9, -0.5), block(-0.5, 0.3), block(0.3, 9)]),
    "blocks drawn the other way round": Map([block(-9, 0)[::-1], block(0, 9)]),
    "blocks of different depths": Map([block(-9, -0.5, 2), block(-0.5, 0.3), block(0.3, 9, 3)]),
    "blocks that overlap": Map([block(-9, 0.1), block(-0.5, 0.6), block(0.3, 9)]),
    "many small blocks": Map([block(*ends, 0.2) for ends in pairwise(CUTS)]),
    "walls that end at the back": Map(
        [[(-9, 0), (9, 0)], [(0, 0), (0, -2)], [(1, -2), (0.5, 0)], [(-0.4, 0), (-2, -0.1)]]
    ),
}


def turned(map_: Map, angle: float, mirrored: bool) -> Map:
    """A map that is mirrored at the x axis, and turned about the origin."""
    c, s, side = cos(angle), sin(angle), -1 if mirrored else 1

    def moved(points):
        return [(c * x - s * side * y, s * x + c * side * y) for x, y in points]

    return Map([moved(each) for each in map_.outlines], walls=[moved(w) for w in map_.walls])


def throw(rng: np.random.Generator) -> Prop:
    """Something that flies at the wall y = 0, and slides on along it."""
    kind = rng.choice([
        Box(length=0.3, width=0.3), Box(length=0.5, width=0.1), Solid(shape=HEXAGON),
        Puck(diameter=0.3),
    ])  # fmt: skip
    angle = rng.choice([0.0, 0.0, rng.uniform(-0.3, 0.3)])
    velocity = rng.uniform(1, 3), -rng.uniform(0.1, 0.6), 0.0
    return kind.replace(
        pose=(rng.uniform(-1.8, -1.2), 0.27, angle), velocity=velocity, friction=0.0,
        restitution=0.0, ground_friction=0.0,
    )  # fmt: skip


def ends(prop: Prop, map_: Map, angle: float = 0.0, mirrored: bool = False) -> np.ndarray:
    """The velocity of a prop after 2.5 m of its way, in the frame in which the map was drawn."""
    c, s, side = cos(angle), sin(angle), -1 if mirrored else 1
    (x, y, theta), (vx, vy, spin) = prop.pose, prop.velocity
    y, vy, theta, spin = side * y, side * vy, side * theta, side * spin
    moved = prop.replace(
        pose=(c * x - s * y, s * x + c * y, theta + angle),
        velocity=(c * vx - s * vy, s * vx + c * vy, spin),
    )
    world = endless([FAR], [moved], addons=[turned(map_, angle, mirrored)], sampling_time=0.05)
    drive(world, [[0], [0]], 2.5 / vx)
    vx, vy, spin = world.prop_velocity[:, 0]
    return np.array([c * vx + s * vy, side * (c * vy - s * vx), side * spin])


@pytest.mark.parametrize("name", SEAMS)
def test_what_is_thrown_at_a_wall_goes_on_as_if_it_had_no_seam(name):
    rng = np.random.default_rng(11)
    straight = Map([[(-9, 0), (9, 0)]])
    for k in range(20):
        prop, angle, mirrored = throw(rng), (0.0, 0.7, -2.1)[k % 3], k % 2 == 1
        found = ends(prop, SEAMS[name], angle, mirrored)
        assert found == pytest.approx(ends(prop, straight, angle, mirrored), abs=1e-6)


@pytest.mark.parametrize(
    "name", ["forty pieces", "many small blocks", "walls that end at the back"]
)
@pytest.mark.parametrize("shape", [None, SQUARE, HEXAGON])
def test_a_robot_drives_along_it_as_along_one_wall(name, shape):
    ways = []
    for map_ in (Map([[(-9, 0), (9, 0)]]), SEAMS[name]):
        robot = Robot(pose=(-1.5, 0.2, -0.3), shape=shape, friction=0.2, drive=Unicycle())
        world = endless([robot], addons=[map_], sampling_time=0.05)
        ways.append(drive(world, [[0.4], [0.0]], 8)[:, :, 0])
    assert ways[1] == pytest.approx(ways[0], abs=1e-6)
    assert ways[0][-1, 0] > 0.5  # it has come over seams


def test_cells_of_a_grid_are_one_wall(tmp_path):
    pixels = np.full((20, 120), 255, dtype=np.uint8)
    pixels[10:, :] = 0
    (tmp_path / "grid.pgm").write_bytes(b"P5 120 20 255\n" + pixels.tobytes())
    map_ = Map.from_file(tmp_path / "grid.pgm", resolution=0.05, at=(-3, -0.5))
    box = Box(
        pose=(-1.5, 0.27, 0), velocity=(2, -0.3, 0), length=0.3, width=0.3, friction=0.0,
        ground_friction=0.0,
    )  # fmt: skip
    assert ends(box, map_) == pytest.approx([2, 0, 0], abs=1e-6)


@pytest.mark.parametrize("degrees", [-30.0, -5.0, -1.0, 1.0, 5.0, 30.0])
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_bend_takes_what_is_across_it_and_no_more(degrees, mirrored):
    """Outwards nothing; inwards a disc keeps v cos(bend), and a box, which may turn, about that."""
    rng = np.random.default_rng(2)
    bend = radians(degrees)
    bent = Map(walls=[[(-9, 0), (0, 0), (9 * cos(bend), 9 * sin(bend))]])
    for k in range(12):
        prop = throw(rng)
        (x, y, _), (vx, vy, _) = prop.pose, prop.velocity
        prop = prop.replace(pose=(x, y - 0.06, 0.0), velocity=(vx, vy, 0.0))
        vx, vy, _ = ends(prop, bent, 0.3 * k, mirrored)
        kept = hypot(vx, vy) / prop.velocity[0]
        if degrees < 0:
            assert kept == pytest.approx(1, abs=1e-6)
        elif isinstance(prop, Puck):
            assert kept == pytest.approx(cos(bend), abs=2e-3)
        else:
            assert cos(bend) - 6e-3 <= kept < 1


def test_a_step_is_felt():
    low, high = block(-9, 0), block(0, 9, 1.02, 0.02)
    box = Box(pose=(-1, 0.16, 0), velocity=(2, -0.1, 0), length=0.3, width=0.3, friction=0.0,
              restitution=0.0, ground_friction=0.0)  # fmt: skip
    assert ends(box, Map([low, high]))[0] < 1.0


@pytest.mark.parametrize("name", SEAMS)
def test_nothing_comes_through_a_seam(name):
    """Small discs and sharp corners that are pressed against it from above."""
    dart = Polygon([(-0.1, -0.02), (0.1, 0.0), (-0.1, 0.02)])
    for x in (-0.5, -0.4, 0.0, 0.1, 0.3):
        robots = [
            Robot(pose=(x + 1e-4, 0.05, -pi / 2), diameter=0.002, mass=0.1, drive=Unicycle()),
            Robot(pose=(x + 0.3, 0.2, -pi / 2), shape=dart, mass=0.1, drive=Unicycle()),
        ]
        world = endless(robots, addons=[SEAMS[name]], sampling_time=0.05)
        way = drive(world, [[0.2, 0.2], [0, 0]], 2)
        assert way[:, 1, 0].min() > -1e-3
        assert way[:, 1, 1].min() > 0.098


def test_a_contact_tells_the_obstacle_that_is_touched():
    pieces = [[(-9, 0), (-0.5, 0)], [(-0.5, 0), (0.5, 0)], [(0.5, 0), (9, 0)]]
    robot = Robot(pose=(-1.5, 0.2, -0.2), friction=0.0)
    world = endless([robot], addons=[Map(pieces)], sampling_time=0.05)
    drive(world, [[0.5], [0]], 6)
    touched = world.record.contacts
    assert set(touched["b"]) == {-1, -2, -3}
    for number, (start, end) in ((-1, (-9, -0.5)), (-2, (-0.5, 0.5)), (-3, (0.5, 9))):
        x = touched["point"][touched["b"] == number][:, 0]
        assert (x >= start - 0.03).all()
        assert (x <= end + 0.03).all()
    assert touched["began"].sum() == 3  # one for each obstacle


@pytest.mark.parametrize("restitution", [0.0, 0.7])
def test_corners_of_rooms_hold_and_corners_of_blocks_are_hit(restitution):
    look = {"friction": 0.0, "restitution": restitution, "ground_friction": 0.0}
    corner = [[(-9, 0), (0, 0)], [(0, 0), (0, 9)]]
    box = Box(pose=(-1, 1, 0), velocity=(1, -1, 0), length=0.3, width=0.3, **look)
    world = endless([FAR], [box], addons=[Map(corner)], sampling_time=0.05)
    drive(world, [[0], [0]], 1.5)
    assert world.prop_velocity[:, 0] == pytest.approx([-restitution, restitution, 0], abs=2e-2)
    ball = Ball(pose=(-1, -1.02, 0), velocity=(1, 1, 0), diameter=0.2, **look)
    single = [[(0, 0), (2, 0), (2, 2), (0, 2)]]
    halves = [[(0, 0), (2, 0), (2, 1), (0, 1)], [(0, 1), (2, 1), (2, 2), (0, 2)]]
    found = []
    for outlines in (single, halves):
        world = endless([FAR], [ball], addons=[Map(outlines)], sampling_time=0.05)
        drive(world, [[0], [0]], 1.5)
        found.append(world.prop_velocity[:, 0])
    assert found[1] == pytest.approx(found[0], abs=1e-9)
    assert found[0][:2] != pytest.approx([1, 1], abs=0.1)


def test_a_large_map_is_ready_at_once():
    """Ten thousand edges of small squares, and as many pieces of one wall, in a few lookups."""
    squares = [block(x, x + 0.1, 0.1, y) for x in np.arange(0, 10, 0.2) for y in range(50)]
    wall = [(0.01 * k, -5.0) for k in range(10001)]
    map_ = Map(squares, walls=[wall])
    scenario = Scenario(robots=[Robot(pose=(-5, 0, 0))], addons=[map_], on_exit="ignore")
    walls = walls_of(scenario.surfaces, 1e-3)
    assert len(walls) == 4 * len(squares) + 1
    assert len(walls[-1].spans) == 10000
    assert World(scenario).pose[0, 0] == -5.0
