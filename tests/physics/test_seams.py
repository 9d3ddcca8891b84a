"""Nothing trips over seams: of walls in one line, of pieces of a body, of bodies that lie flush."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import ceil, cos, hypot, pi, radians, sin
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from mars2d import Holonomic, Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies.props import Box, Prop, Puck, Solid
from mars2d.geometry.shapes import Compound, Polygon
from mars2d.physics import translation, walls
from mars2d.physics.walls import MEET, walls_of
from tests.cases import each_case
from tests.islands import plainly

SMOOTH = {"friction": 0.0, "ground_friction": 0.0, "restitution": 0.0}

Image = tuple[float, int]
"""An angle by which a scene is turned, and 1, or -1 if it is mirrored before."""

IMAGES: list[Image] = [(0.0, 1), (0.37, 1), (2.1, -1)]

ONE = SimpleNamespace(walls=[[(-9, 0), (9, 0)]])


def blocks(*tops: float, wide: float = 0.5) -> list:
    """Blocks that adjoin, with their tops at these heights, the middle at 0."""
    left = -len(tops) / 2 * wide
    edges = [(left + k * wide, left + (k + 1) * wide, top) for k, top in enumerate(tops)]
    return [[(a, -1), (b, -1), (b, top), (a, top)] for a, b, top in edges]


STRAIGHT = {
    "three points": SimpleNamespace(walls=[[(-9, 0), (0, 0), (9, 0)]]),
    "two walls": SimpleNamespace(walls=[[(-9, 0), (0.1, 0)], [(9, 0), (0.1, 0)]]),
    "overlapping": SimpleNamespace(walls=[[(-9, 0), (0.3, 0)], [(9, 0), (-0.2, 0)]]),
    "missed by a nanometre": SimpleNamespace(walls=[[(-9, 0), (-1e-9, 1e-9)], [(1e-9, 0), (9, 0)]]),
    "forty pieces": SimpleNamespace(walls=[[(-9 + 0.45 * k, 0) for k in range(41)]]),
    "blocks": SimpleNamespace(outlines=blocks(*[0.0] * 36)),
    "ends from behind": SimpleNamespace(
        walls=[[(-9, 0), (9, 0)], *([(k / 3, 0), (k / 3 + sin(k) / 5, -1)] for k in range(-15, 16))]
    ),
    "corners from behind": SimpleNamespace(
        walls=[[(-9, 0), (9, 0)]],
        outlines=[[(k / 2, 0), (k / 2 + 0.1, -0.4), (k / 2 + 0.3, 0)] for k in range(-10, 10)],
    ),
    "blocks in a block": SimpleNamespace(
        outlines=[[(-9, -1), (9, -1), (9, 0), (-9, 0)], *blocks(*[0.0] * 16)[::2]]
    ),
}
"""Scenes in which the x axis is a straight wall."""


def seen(point, image: Image) -> tuple[float, float]:
    """The image of a direction."""
    (x, y), (angle, sense) = point, image
    y *= sense
    return x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)


def at(point, image: Image) -> tuple[float, float]:
    """The image of a point."""
    x, y = seen(point, image)
    return x + 0.3, y - 0.2


def map_of(scene: SimpleNamespace, image: Image) -> Map:
    """The image of a scene's obstacles."""
    outlines, lines = (
        [[at(point, image) for point in line] for line in getattr(scene, kind, [])]
        for kind in ("outlines", "walls")
    )
    return Map(outlines or None, walls=lines)


def world_of(
    *props: Prop, walls: Map | None = None, robot: Robot | None = None, time: float = 1.5,
    step: float = 0.05,
) -> World:  # fmt: skip
    """Props, walls if any, and a robot, which is far away if none is given, for some time."""
    return World(
        Scenario(
            robots=[robot or Robot(pose=(40, 40, 0))], props=props, addons=[walls] if walls else [],
            workspace=None, stop_time=ceil(time / step) * step, sampling_time=step,
        )
    )  # fmt: skip


def ended(world: World, command: Any = ((0.0,), (0.0,))) -> World:
    """Go on to the end."""
    while not world.over:
        world.step(np.array(command))
    return world


def after(world: World, image: Image) -> np.ndarray:
    """What is left of the first prop's velocity, as in the scene and not its image."""
    (angle, sense), (x, y, spin) = image, ended(world).prop_velocity[:, 0]
    back = x * cos(angle) + y * sin(angle), sense * (y * cos(angle) - x * sin(angle))
    return np.array([*back, sense * spin])


def along(prop: Prop, image: Image) -> float:
    """The velocity of a prop along the x axis of the scene."""
    return float(np.array(seen((1, 0), image)) @ prop.velocity[:2])


def rectangle_of(left: float, right: float, low: float, high: float) -> Polygon:
    return Polygon([(left, low), (right, low), (right, high), (left, high)])


def ngon(corners: int, radius: float) -> Polygon:
    turns = [2 * pi * k / corners + 0.3 for k in range(corners)]
    return Polygon([(radius * cos(turn), radius * sin(turn)) for turn in turns])


def thrown(k: int, image: Image) -> Prop:
    """The image of a box, polygon or disc that is thrown at the x axis from above."""
    rng = np.random.default_rng(k)
    radius = rng.uniform(0.05, 0.3)
    place = rng.uniform(-2, -0.5), rng.uniform(0.32, 0.5)
    velocity = rng.uniform(0.5, 4), -rng.uniform(0.05, 0.6)
    angle, spin = (0.0, 0.0) if k % 2 else (rng.uniform(-3, 3), rng.uniform(-2, 2))
    what = {
        "pose": (*at(place, image), image[0] + image[1] * angle),
        "velocity": (*seen(velocity, image), image[1] * spin),
    }
    if k % 4 < 2:
        return Box(length=2 * radius, width=rng.uniform(0.5, 1.5) * radius, **what, **SMOOTH)
    if k % 4 == 2:
        return Solid(shape=ngon(3 + k % 6, radius), **what, **SMOOTH)
    return Puck(diameter=2 * radius, **what, **SMOOTH)


def velocity_after(prop: Prop, walls: Map, image: Image = (0.0, 1)) -> np.ndarray:
    return after(world_of(prop, walls=walls), image)


# -- what is straight -------------------------------------------------------------------------


@pytest.mark.slow
@each_case("name", STRAIGHT)
def test_sixty_throws_go_on_as_on_one_wall(name):
    """Without friction and floor the speed along a straight wall is kept for ever."""
    for k in range(60):
        image = IMAGES[k // 20]
        prop = thrown(k, image)
        found = velocity_after(prop, map_of(STRAIGHT[name], image), image)
        expected = velocity_after(prop, map_of(ONE, image), image)
        assert found == pytest.approx(expected, abs=1e-6), k
        assert found[0] == pytest.approx(along(prop, image), abs=1e-6), k


@each_case("image", IMAGES)
def test_ends_from_behind_are_not_felt_even_near_the_wall_s_own_end(monkeypatch, image):
    """There the pair of body and end can't be left out; the contact is void all the same."""
    original = walls.walls_of
    monkeypatch.setattr(
        translation, "walls_of", lambda parts: tuple(w._replace(shades=()) for w in original(parts))
    )
    for name in ("ends from behind", "corners from behind"):
        for k in range(12):
            prop = thrown(k, image)
            found = velocity_after(prop, map_of(STRAIGHT[name], image), image)
            assert found[0] == pytest.approx(along(prop, image), abs=1e-6), (name, k)


def test_a_wall_of_two_surfaces_is_not_tripped_over():
    """It stays two walls, since their friction differs."""
    for k in range(30):
        prop = thrown(k, (0.0, 1))
        scenario = world_of(prop).scenario
        parts = [
            Map([[(-9, -0.2), (0.1, -0.2)]], friction=0.9),
            Map([[(0.1, -0.2), (9, -0.2)]], friction=0.1, name="smooth"),
        ]
        found = after(World(scenario.replace(addons=parts)), (0.0, 1))
        assert found[0] == pytest.approx(prop.velocity[0], abs=1e-6), k


@each_case("image", IMAGES)
def test_a_square_robot_drives_along_forty_pieces_as_along_one(image):
    """Pressed against it with friction, by its drive; with one piece each it stood for good."""
    poses = []
    for scene in (ONE, STRAIGHT["forty pieces"], STRAIGHT["ends from behind"]):
        robot = Robot(
            shape=rectangle_of(-0.2, 0.2, -0.2, 0.2), drive=Holonomic(), friction=0.4,
            pose=(*at((-2, 0.3), image), image[0]),
        )  # fmt: skip
        world = world_of(walls=map_of(scene, image), time=8, robot=robot)
        poses.append(ended(world, [[0.6], [-0.3 * image[1]]]).pose[:, 0])
    way = np.array(poses[0][:2]) - at((-2, 0.2), image)
    assert hypot(*way) > 1.5
    assert poses[1] == pytest.approx(poses[0], abs=1e-9)
    assert poses[2] == pytest.approx(poses[0], abs=1e-6)


# -- what is not straight ---------------------------------------------------------------------


@each_case("degrees", [0.01, 1.0, 9.0, 30.0, 80.0])
@each_case("image", IMAGES)
def test_a_bend_takes_the_velocity_across_it_and_no_more(degrees, image):
    """A disc that slides without friction keeps v cos a, in the direction of what comes."""
    a = radians(degrees)
    bent = SimpleNamespace(walls=[[(-9, 0), (0, 0), (9 * cos(a), 9 * sin(a))]])
    puck = Puck(
        diameter=0.3, pose=(*at((-1, 0.1501), image), 0),
        velocity=(*seen((2.0, -1e-3), image), 0.0), **SMOOTH,
    )  # fmt: skip
    found = velocity_after(puck, map_of(bent, image), image)
    speed = 2 * cos(a)
    assert found[:2] == pytest.approx([speed * cos(a), speed * sin(a)], abs=2e-4)


@each_case("degrees", [1.0, 5.0, 45.0, 90.0, 135.0])
@each_case("kind", ["walls", "outlines"])
@each_case("image", IMAGES)
def test_what_slides_over_a_corner_that_falls_away_keeps_its_velocity(degrees, kind, image):
    """Nothing is there any more: neither a line's end nor a solid's next edge holds it back."""
    a = radians(degrees)
    line = [(-9, 0), (0, 0), (2 * cos(a), -2 * sin(a))]
    scene = SimpleNamespace(**{kind: [line if kind == "walls" else [*line, (-9, -4)]]})
    for k in range(4):
        box = Box(
            length=0.3, width=0.2, pose=(*at((-1 - k / 17, 0.1), image), image[0]),
            velocity=(*seen((2.3 - k / 3, -1e-4), image), 0.0), **SMOOTH,
        )  # fmt: skip
        found = velocity_after(box, map_of(scene, image), image)
        assert found[0] == pytest.approx(2.3 - k / 3, abs=1e-6)
        assert hypot(*found[1:]) < 2e-3


@each_case("height", [0.5, 0.3])
@each_case("kind", ["blocks", "walls"])
@each_case("image", IMAGES)
def test_a_step_is_felt(height, kind, image):
    """Above the middle of a box of 0.3 m its push goes through it: the box stands."""
    scene = SimpleNamespace(outlines=blocks(0.0, 0.0, height, height, wide=2.0))
    if kind == "walls":
        scene = SimpleNamespace(walls=[[(-4, 0), (0, 0), (0, height), (4, height)]])
    box = Box(
        length=0.3, width=0.3, pose=(*at((-1, 0.15), image), image[0]),
        velocity=(*seen((2.0, -0.01), image), 0.0), **SMOOTH,
    )  # fmt: skip
    found = velocity_after(box, map_of(scene, image), image)
    assert found == pytest.approx([0, 0, 0], abs=1e-2)


@each_case("image", IMAGES)
def test_a_corner_of_walls_is_hit_as_that_of_a_polygon(image):
    """From outside, at all angles: the same bits, but for rounding."""
    block = SimpleNamespace(outlines=[[(0, -2), (2, -2), (2, 0), (0, 0)]])
    lines = SimpleNamespace(walls=[[(2, 0), (0, 0), (0, -2)], [(0, -2), (2, -2), (2, 0)]])
    hit = 0
    for k in range(12):
        rng = np.random.default_rng(k)
        place, way = rng.uniform(-0.6, -0.3, 2) * (1, -1), rng.uniform(0.2, 1.0, 2) * (1, -1)
        box = Box(
            length=0.3, width=0.2, pose=(*at(place, image), rng.uniform(0, 3)),
            velocity=(*seen(way, image), 0.5), **SMOOTH,
        )  # fmt: skip
        found = velocity_after(box, map_of(block, image), image)
        assert found == pytest.approx(velocity_after(box, map_of(lines, image), image), abs=1e-9)
        hit += hypot(*(found[:2] - way)) > 1e-3
    assert hit > 4


@each_case("kind", ["walls", "tee", "blocks"])
@each_case("image", IMAGES)
def test_a_box_that_is_pushed_into_a_corner_rests_against_both_walls(kind, image):
    scene = {
        "walls": SimpleNamespace(walls=[[(-4, 0), (0, 0), (0, 4)]]),
        "tee": SimpleNamespace(walls=[[(-4, 0), (4, 0)], [(0, 0), (0, 4)]]),
        "blocks": SimpleNamespace(outlines=blocks(0, 0, 2, 2, wide=2.0)),
    }[kind]
    box = Box(
        length=0.3, width=0.3, pose=(*at((-0.5, 0.5), image), image[0]), ground_friction=0.1,
        velocity=(*seen((1.5, -1.5), image), 0.0), friction=0.1, restitution=0.0,
    )  # fmt: skip
    world = ended(world_of(box, walls=map_of(scene, image)))
    assert world.prop_pose[:2, 0] == pytest.approx(at((-0.15, 0.15), image), abs=1.2e-3)
    assert world.prop_velocity[:, 0] == pytest.approx([0, 0, 0], abs=1e-9)


BENDS = {
    "straight": [[(-9, 0), (0, 0), (9, 0)]],
    "concave": [[(-9, 0), (0, 0), (9, 0.17)]],
    "bulging": [[(-9, 0), (0, 0), (9, -0.17)]],
    "steep": [[(-9, 0), (0, 0), (9, 5)]],
    "corner": [[(-3, 0), (0, 0), (0, -3)]],
    "tee": [[(-9, 0), (9, 0)], [(0, 0), (0, -3)]],
    "fork": [[(-9, 0), (0, 0), (9, 0.3)], [(0, 0), (0, -3)]],
}

TIPS = {
    "tip": {"shape": Polygon([(0, -0.1), (0.1, 0), (0, 0.1), (-0.1, 0)])},
    "needle": {"shape": Polygon([(0, -0.1), (0.02, 0.05), (-0.02, 0.05)])},
    "disc": {"diameter": 0.1},
    "bead": {"diameter": 0.002},
}


def pressing(world: World, prop: Prop) -> Iterator[np.ndarray]:
    """Let a robot press on a prop; yield where its corners or its middle are, (k, 2)."""
    corners = np.array(prop.shape.pieces[0].vertices if isinstance(prop, Solid) else [(0.0, 0.0)])
    while not world.over:
        world.step(np.array([[0.0], [-0.3]]))
        x, y, angle = world.prop_pose[:, 0]
        turn = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
        yield corners @ turn + (x, y)


PRESS = Robot(shape=rectangle_of(-0.2, 0.2, -0.3, 0.3), drive=Holonomic())


@each_case("bend", BENDS)
@each_case("tip", TIPS)
@each_case("off", [1e-5, 1e-3])
def test_nothing_is_pressed_through_a_seam(bend, tip, off):
    """A robot presses it there for seconds; no point of it gets deeper than bodies may."""
    kind = Solid if "shape" in TIPS[tip] else Puck
    prop = kind(pose=(off, 0.15, 0), **TIPS[tip], **SMOOTH)
    world = world_of(prop, walls=Map(walls=BENDS[bend]), robot=PRESS.at(0, 0.62), time=3)
    deepest, radius = 0.0, TIPS[tip].get("diameter", 0.0) / 2
    line = BENDS[bend][0][: 2 if bend == "corner" else 3]
    for points in pressing(world, prop):
        above = points[points[:, 0] <= 0] if bend == "corner" else points
        depth = np.interp(above[:, 0], *zip(*line, strict=True)) - above[:, 1] + radius
        deepest = max(deepest, depth.max(initial=0.0))
    assert deepest > 0 or bend == "corner"  # it was pressed, or slid off
    assert deepest < 1.6e-3 if bend == "steep" else deepest < 1.1e-3


# -- bodies that lie flush --------------------------------------------------------------------

FIRM = {"friction": 0.0, "restitution": 0.0, "ground_friction": 5.0, "mass": 9.0}
"""A smooth crate that the floor holds."""

ROWS = {
    "two crates": [(-1, 0), (0, 1)],
    "three crates": [(-1, -0.2), (-0.2, 0.3), (0.3, 1)],
    "two pieces": [(-1, 0, 1)],
    "three pieces": [(-1, -0.2, 0.3, 1)],
}
"""Bodies in a row from -1 m to 1 m along the x axis: the ends of the pieces of each."""


def slab(*ends: float, middle: float, image: Image, **what: Any) -> Solid:
    """A body of pieces side by side, 0.5 m wide, with its middle at this height."""
    pieces = [rectangle_of(a, b, -0.25, 0.25) for a, b in pairwise(ends)]
    pose = (*at(((ends[0] + ends[-1]) / 2, middle), image), image[0])
    return Solid(Compound(pieces), **{"pose": pose, **FIRM, **what})


def row(name: str, image: Image, top: float = 0.0) -> list[Solid]:
    """A row whose upper side is at this height; its lower side if that is above 0."""
    middle = top + 0.25 if top else -0.25
    return [slab(*ends, middle=middle, image=image) for ends in ROWS[name]]


def slider(k: int, image: Image) -> tuple[Prop, float]:
    """A box, polygon or disc that is thrown along a row, and the time until it is near its end."""
    rng = np.random.default_rng(k)
    radius, speed, down = rng.uniform(0.05, 0.2), rng.uniform(0.5, 5), rng.uniform(0.05, 0.6)
    angle, spin = (0.0, 0.0) if k % 2 else (rng.uniform(-3, 3), rng.uniform(-2, 2))
    wide = radius * rng.uniform(0.5, 1.5)
    high = radius if k % 4 > 1 else hypot(radius, wide / 2) if angle else wide / 2
    start = rng.uniform(-0.8, -0.4)
    what = {
        "pose": (*at((start, high + rng.uniform(5e-4, 0.02)), image), image[0] + angle),
        "velocity": (*seen((speed, -down), image), spin), **SMOOTH,
    }  # fmt: skip
    time = (0.6 - start) / speed
    if k % 4 < 2:
        return Box(length=2 * radius, width=wide, mass=1.0, **what), time
    if k % 4 == 2:
        return Solid(shape=ngon(3 + k % 6, radius), mass=1.0, **what), time
    return Puck(diameter=2 * radius, mass=1.0, **what), time


TURNED: list[Image] = [(0.0, 1), (0.37, 1), (2.0, 1)]

TIMES = (0.005, 0.02, 0.05, 0.1, 0.5)
"""Sampling times, seconds."""


def test_sixty_throws_keep_their_speed_along_bodies_that_lie_flush():
    """There is no friction: a row has nothing that could push along it. Half are of pieces."""
    failed = {}
    for k in range(90):
        image, step = TURNED[k % 3], TIMES[k % 5]
        prop, time = slider(4 * k + 1 if k >= 60 else k, image)
        if k >= 60:
            half, high = prop.length / 2, prop.width / 2
            ends = (-half, 0, half) if k % 2 else (-half, -half / 3, half / 2, half)
            pieces = [rectangle_of(a, b, -high, high) for a, b in pairwise(ends)]
            prop = Solid(Compound(pieces), pose=prop.pose, velocity=prop.velocity, **SMOOTH)
        floor = row(list(ROWS)[k // 4 % 4], image)
        found = after(world_of(prop, *floor, time=time, step=step), image)
        if abs(found[0] - along(prop, image)) > 1e-3:
            failed[k] = found
    assert not failed


def test_thirty_throws_between_two_rows_go_straight_on():
    failed = {}
    for k in range(30):
        rng = np.random.default_rng(k)
        image = TURNED[k % 3]
        high, speed, play = rng.uniform(0.1, 0.4), rng.uniform(0.5, 5), rng.uniform(1e-4, 2e-3)
        what = {
            "pose": (*at((-0.7, (high + play) / 2), image), image[0]), "mass": 1.0, **SMOOTH,
            "velocity": (*seen((speed, rng.uniform(-0.05, 0.05)), image), 0.0),
        }  # fmt: skip
        prop = Box(length=0.3, width=high, **what) if k % 2 else Puck(diameter=high, **what)
        below, above = list(ROWS)[k % 4], list(ROWS)[k // 4 % 4]
        rows = [*row(below, image), *row(above, image, top=high + play)]
        found = after(world_of(prop, *rows, time=1.2 / speed, step=TIMES[k % 5]), image)
        if abs(found - [speed, 0, 0]).max() > 6e-3 or abs(found[0] - speed) > 1e-3:
            failed[k] = found
    assert not failed


def test_momentum_is_kept_over_crates_that_slide_too():
    for k in range(8):
        prop, _ = slider(k, (0.0, 1))
        floor = [
            slab(*ends, middle=-0.25, image=(0.0, 1), ground_friction=0.0)
            for ends in ROWS["three crates"]
        ]
        momentum = ended(world_of(prop, *floor, time=0.5)).momentum.total
        assert momentum == pytest.approx(prop.velocity[:2], abs=1e-9), k


@each_case("name", ROWS)
def test_a_square_robot_that_presses_on_a_row_drives_along_it(name):
    """With friction, as along one block; on two crates it stood for good."""
    poses = []
    for ends in ([(-1, 1)], ROWS[name]):
        robot = Robot(
            shape=rectangle_of(-0.2, 0.2, -0.2, 0.2), drive=Holonomic(), friction=0.4,
            pose=(*at((-0.7, 0.21), (0.0, 1)), 0.0),
        )  # fmt: skip
        floor = [
            slab(*each, middle=-0.25, image=(0.0, 1), friction=0.4, ground_friction=9.0)
            for each in ends
        ]
        world = ended(world_of(*floor, robot=robot, time=4), [[0.3], [-0.1]])
        poses.append(world.pose[:, 0])
    assert poses[0][0] > 0.5
    assert poses[1] == pytest.approx(poses[0], abs=1e-3)


@each_case("step", [5e-3, 3e-3])
def test_a_step_of_crates_is_felt(step):
    """A plate that is thin beside its length is stopped by it, and turns no more."""
    plate = Box(
        length=0.3, width=0.006, pose=(*at((-0.4, 0.0035), (0.0, 1)), 0.0),
        velocity=(2.0, -0.05, 0.0), mass=1.0, **SMOOTH,
    )  # fmt: skip
    low = slab(-1, 0, middle=-0.25, image=(0.0, 1))
    high = slab(0, 1, middle=-0.25 + step, image=(0.0, 1))
    found = after(world_of(plate, low, high, time=0.4), (0.0, 1))
    assert found == pytest.approx([0, 0, 0], abs=0.25)
    assert found[0] == pytest.approx(0, abs=1e-2)


@each_case("off", [0.0, 1e-5, -3e-4, 1e-3])
def test_no_needle_is_pressed_into_a_seam_of_bodies(off):
    """A robot presses it there for seconds; it gets no deeper than bodies may."""
    needle = Solid(shape=TIPS["needle"]["shape"], pose=(off, 0.105, 0), mass=1.0, **SMOOTH)
    floor = [
        slab(*ends, middle=-0.25, image=(0.0, 1), pose=((ends[0] + ends[1]) / 2, -0.25, 0),
             ground_friction=20.0)
        for ends in ROWS["two crates"]
    ]  # fmt: skip
    world = world_of(needle, *floor, robot=PRESS.at(0, 0.46), time=2)
    deepest = 0.0
    for points in pressing(world, needle):
        deepest = max(deepest, world.prop_pose[1, 1:].max() + 0.25 - points[:, 1].min())
    assert 0 < deepest < 1.1e-3


@each_case("scene", [*BENDS, *range(4)])
def test_seams_and_rows_give_the_same_bits_where_nothing_is_compiled(scene):
    def states() -> list[bytes]:
        worlds = []
        if isinstance(scene, int):
            prop, _ = slider(scene, TURNED[scene % 3])
            worlds = [world_of(prop, *row(list(ROWS)[scene], TURNED[scene % 3]), time=0.4)]
        else:
            chart = map_of(SimpleNamespace(walls=BENDS[scene]), (0.0, 1))
            worlds = [world_of(thrown(k, (0.0, 1)), walls=chart, time=1.0) for k in range(3)]
        return [
            array.tobytes()
            for world in map(ended, worlds)
            for array in (world.prop_pose, world.prop_velocity, world.record.contacts)
        ]

    quick = states()
    with plainly():
        assert states() == quick


# -- whose a wall is --------------------------------------------------------------------------


def test_a_contact_says_which_piece_of_a_wall_is_touched():
    place = at((-1, 0.1001), (0.0, 1))
    prop = Puck(diameter=0.2, pose=(*place, 0), velocity=(2, -0.05, 0), **SMOOTH)
    chart = map_of(STRAIGHT["three points"], (0.0, 1))
    contacts = ended(world_of(prop, walls=chart)).record.contacts
    assert set(contacts["b"].tolist()) == {-1, -2}
    middle = at((0, 0), (0.0, 1))[0]
    before = contacts["point"][:, 0] < middle
    assert (contacts["b"] == np.where(before, -1, -2)).all()


# -- which walls there are --------------------------------------------------------------------


def parts(*obstacles, surface=(1.0, 1.0)):
    return tuple((tuple(map(tuple, outline)), surface, True) for outline in obstacles)


def ends_of(found) -> set:
    return {tuple(sorted((wall.start, wall.end))) for wall in found}


def test_pieces_in_one_line_are_one_wall_in_the_direction_of_the_first():
    [wall] = walls_of(parts([(0, 0), (1, 0)], [(3, 0), (1, 0)], [(2.5, 0), (4, 0)]))
    assert (wall.start, wall.end) == ((0, 0), (4, 0))
    assert wall.owners == ((0.0, 0), (1.0, 1), (3.0, 2))


def test_walls_that_bend_or_differ_in_surface_stay_as_they_are():
    bent = parts([(0, 0), (1, 0)], [(1, 0), (2, 3 * MEET)])
    assert len(walls_of(bent)) == 2
    first, second = parts([(0, 0), (1, 0)]), parts([(1, 0), (2, 0)], surface=(0.5, 1.0))
    assert len(walls_of(first + second)) == 2


def test_a_line_that_bends_too_little_at_each_piece_is_not_straightened():
    radius, count = 1e4, 1000
    turns = [2e-7 * k for k in range(count + 1)]
    arc = [(radius * sin(turn), radius * (1 - cos(turn))) for turn in turns]
    assert len(walls_of(parts(*pairwise(arc)))) == count


def test_what_adjoining_solids_have_in_common_is_left_out():
    low, high = [(0, 0), (1, 0), (1, 1), (0, 1)], [(1, 0), (2, 0), (2, 3), (1, 3)]
    found = ends_of(walls_of(parts(low, high[::-1])))
    assert found == {
        ((0, 0), (2, 0)), ((0, 0), (0, 1)), ((0, 1), (1, 1)), ((1, 1), (1, 3)), ((1, 3), (2, 3)),
        ((2, 0), (2, 3)),
    }  # fmt: skip
    # an outline that is there twice has its inside on one side
    assert ends_of(walls_of(parts(low, low))) == ends_of(walls_of(parts(low)))


def test_walls_in_one_place_are_looked_at_once(monkeypatch):
    counts = []
    meetings = walls._meetings
    monkeypatch.setattr(
        walls, "_meetings", lambda lines: counts.append(len(lines)) or meetings(lines)
    )
    box = [(0, 0), (2, 0), (2, 1), (0, 1)]
    assert walls_of(parts(*[box, box[::-1]] * 1500)) == walls_of(parts(box))
    assert max(counts) == 4


def test_the_workspace_is_no_solid():
    room, block = [(0, 0), (4, 0), (4, 3), (0, 3)], [(0, 0), (1, 0), (1, 1), (0, 1)]
    inside = (*parts(block), (tuple(room), (1.0, 1.0), False))
    assert ((0, 0), (4, 0)) in ends_of(walls_of(inside))


def test_a_wall_knows_what_it_meets_on_each_side():
    lines = parts([(0, 0), (1, 0)], [(1, 0), (1, 1)], [(1, 0), (2, -2)])
    first = next(wall for wall in walls_of(lines) if wall.end == (1, 0))
    at_start, again, left, right = first.seams
    assert at_start is None
    assert again is None
    assert left == ((0, 1), False)
    assert right.way == pytest.approx((5**-0.5, -2 * 5**-0.5))
    assert not right.bulges
    square = walls_of(parts([(0, 0), (1, 0), (1, 1), (0, 1)]))
    assert [seam.bulges for seam in square[0].seams] == [False, True, False, True]


def test_meetings_are_those_that_all_pairs_have():
    """In the plane's cells as by brute force, for lines of all lengths on a coarse grid."""
    rng = np.random.default_rng(5)
    points = rng.integers(0, 8, (120, 4)) / 4
    lines = [((a, b), (c, d)) for a, b, c, d in points.tolist() if (a, b) != (c, d)]
    lines += [((0.25, 90.0), (700.0, 90.0)), ((3.0, 90.0), (3.0, 91.0))]

    def touches(point, line) -> bool:
        (x, y), (u, v) = line
        along = np.subtract((u, v), (x, y)) / hypot(u - x, v - y)
        to = np.subtract(point, (x, y))
        past = to @ along
        off = abs(to[0] * along[1] - to[1] * along[0])
        return off <= MEET and -MEET <= past <= hypot(u - x, v - y) + MEET

    expected = [
        tuple([j for j, other in enumerate(lines) if j != k and touches(p, other)] for p in line)
        for k, line in enumerate(lines)
    ]
    assert len(lines) > walls.FEW
    assert [tuple(each) for each in walls._meetings(lines)] == expected
