"""Crowds of everything at once: nothing tunnels, overlaps by more than a millimetre, or hangs.

What is measured is measured after every substep, by the narrow phase of pymunk's engine and by the
corners' places, not by what this project computes of gaps. The islands are looked at in Python;
that those which are compiled do the same to the bit is shown in `test_same_bits.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import hypot, inf, pi

import numpy as np
import pymunk
import pytest

from mars2d import Holonomic, Robot, Scenario, Unicycle, World
from mars2d.bodies.joints import Hinge, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Prop, Puck, Solid
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.island import Island
from mars2d.physics.islands.mover import Mover
from tests.cases import each_case
from tests.islands import (
    WALLS_ALONE,
    looked_at,
    plainly,
    pymunk_space,
    states_of,
)

ALLOWED = 1e-3  # metres, the default of Scenario.max_overlap

ELL = Polygon([(0, 0), (0.3, 0), (0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0, 0.3)])
DUMBBELL = Compound([Disc(0.12).moved(-0.1, 0), Disc(0.12).moved(0.1, 0)])
WEDGE = Polygon([(-0.12, -0.1), (0.15, 0), (-0.12, 0.1)])

Maker = Callable[[np.random.Generator], Robot | Prop]


def disc_robot(rng: np.random.Generator) -> Robot:
    drive = (Unicycle, Holonomic)[int(rng.integers(2))](max_linear_speed=2.0)
    return Robot(diameter=rng.uniform(0.15, 0.3), drive=drive)


def box_robot(rng: np.random.Generator) -> Robot:
    x, y = rng.uniform(0.08, 0.15, 2)
    drive = (Unicycle, Holonomic)[int(rng.integers(2))](max_linear_speed=2.0)
    return Robot(shape=Polygon([(-x, -y), (x, -y), (x, y), (-x, y)]), drive=drive)


def wedge_robot(rng: np.random.Generator) -> Robot:
    offset, drive = rng.uniform(-0.1, 0.1), Unicycle(max_linear_speed=2.0)
    return Robot(shape=WEDGE, center_offset=offset, mass_offset=0.05, drive=drive)


PROPS: dict[str, Callable[[np.random.Generator], Prop]] = {
    "box": lambda rng: Box(
        **dict(zip(("length", "width"), rng.uniform(0.1, 0.35, 2), strict=True)),
        ground_friction=rng.uniform(0, 0.6),
    ),
    "bar": lambda rng: Bar(
        length=rng.uniform(0.3, 0.6), thickness=0.04, ground_friction=rng.uniform(0, 0.3)
    ),
    "ball": lambda rng: Ball(diameter=rng.uniform(0.1, 0.25)),
    "puck": lambda rng: Puck(diameter=rng.uniform(0.1, 0.25)),
    "ell": lambda rng: Solid(ELL, ground_friction=rng.uniform(0, 0.3)),
    "dumbbell": lambda _: Solid(DUMBBELL, ground_friction=0.0),
}

MIXES: dict[str, tuple[list[Maker], list[str]]] = {
    "discs": ([disc_robot], ["ball", "puck"]),
    "polygons": ([box_robot, wedge_robot], ["box", "bar", "ell"]),
    "everything": ([disc_robot, box_robot, wedge_robot], [*PROPS]),
}
"""The robots and the props of each kind of crowd."""


def crowd(seed: int, mix: str, mass_ratio: float, sampling_time: float, *, ties: bool) -> Scenario:
    """A room with four robots and eight props at random, and joints between some of them."""
    rng = np.random.default_rng(seed)
    robots, props = MIXES[mix][0], [PROPS[name] for name in MIXES[mix][1]]
    restitution = rng.choice([0.0, 0.5, 1.0])
    bodies: list[Robot | Prop] = []
    for i in range(12):
        makers = robots if i < 4 else props
        make = makers[int(rng.integers(len(makers)))]
        looks = {
            "mass": mass_ratio ** float(rng.integers(3) / 2),
            "friction": float(rng.choice([0.0, 0.5, 1.0])),
            "restitution": float(restitution),
        }
        body = make(rng).replace(**looks)
        if i >= 4:
            body = body.replace(velocity=(*rng.uniform(-1.4, 1.4, 2), rng.uniform(-5, 5)))
        bodies.append(body)
    size, placed = placed_at_random(rng, bodies)
    h = size / 2
    team, things = placed[:4], placed[4:]
    return Scenario(
        robots=team,
        props=things,
        joints=tied(rng, team, things) if ties else (),
        workspace=[(-h, -h), (h, -h), (h, h), (-h, h)],
        on_exit="wall",
        sampling_time=sampling_time,
        stop_time=1e3,
    )


def placed_at_random(
    rng: np.random.Generator, bodies: list[Robot | Prop]
) -> tuple[float, list[Robot | Prop]]:
    """The side of a room, and the bodies in it so that the circles round them do not overlap."""
    circles = [(b.chassis if isinstance(b, Robot) else b.shape).bound for b in bodies]
    reach = [hypot(*center) + radius for center, radius in circles]
    area = sum(pi * r * r for r in reach)
    size = (area / 0.4) ** 0.5
    while True:
        places: list[tuple[float, float, float]] = []
        for _ in range(3000):
            i = len(places)
            x, y = rng.uniform(-1, 1, 2) * (size / 2 - reach[i] - 1e-3)
            apart = (
                hypot(x - p, y - q) > r + reach[i]
                for (p, q, _), r in zip(places, reach, strict=False)
            )
            if all(apart):
                places.append((float(x), float(y), float(rng.uniform(-3, 3))))
                if len(places) == len(bodies):
                    return size, [b.at(*p) for b, p in zip(bodies, places, strict=True)]
        size *= 1.05


def tied(rng: np.random.Generator, robots: list[Robot], props: list[Prop]) -> list:
    """A tow rope, a rod, a spring, and a prop on a hinge; the bodies get names of their own."""
    kinds = [type(prop).__name__.lower() + str(i) for i, prop in enumerate(props)]
    x, y, _ = props[3].pose
    return [
        Rope(a="robot0", b=kinds[0]),
        Rod(a=kinds[1], b=kinds[2]),
        Spring(a="robot1", b=kinds[4], stiffness=30, damping=float(rng.choice([0, 1.0]))),
        Hinge(a=kinds[3], anchor_b=(x, y), limits=(-2, 2)),
    ]


@dataclass
class Watch:
    """What a run was seen to do."""

    deepest: float = 0.0  # metres
    outside: float = 0.0  # metres that something reaches beyond the room
    escaped: str = ""  # whose middle has crossed a wall
    who: tuple[int, int] = (0, 0)
    when: int = 0
    substeps: int = 0
    surplus: float = -inf  # of an island's substeps, beyond what it may take in a control step


def middle_of(shape: pymunk.Shape) -> tuple[float, float]:
    """Return a point deep within a convex shape, in its body's frame."""
    corners = [shape.offset] if isinstance(shape, pymunk.Circle) else shape.get_vertices()
    x, y = np.mean(corners, axis=0).tolist()
    return x, y


def most_substeps(island: Island, duration: float, path: float) -> float:
    """Return how many substeps an island may take, in which points go `path` metres at most.

    One is as long as contacts allow, or two points come nearer by a 256th of what they may enter:
    that bound is asked for vertices beside each other, too, so an edge that turns on a corner takes
    many. Fifty are for drives that brake spins, and for substeps that grow.
    """
    entry = island.accuracy.entry
    return 50 + 2 * duration / island.contact_step + 256 * 2 * path / entry


class Watcher:
    """Looks at the bodies of each island after each of its substeps, and at all after each tick."""

    def __init__(self, world: World) -> None:
        """Make all shapes once more, in pymunk."""
        self.world, self.watch = world, Watch()
        bodies = world.scenario.bodies
        self.state = np.hstack([world.pose, world.prop_pose]).T
        pieces = [body.shape.pieces for body in bodies]
        self.space, self.movers = pymunk_space(pieces, self.state, world.obstacles)
        self.reach = np.array([body.shape.reach for body in bodies])
        self.passing = {frozenset(pair) for pair in world.scenario.joined}
        self.count, self.path = 0, 0.0

    def look(self, who: np.ndarray, state: np.ndarray) -> None:
        """Look at some bodies, which are at `state` now, (k, 3)."""
        assert np.isfinite(state).all()
        before, self.state[who] = self.state[who], state
        moved = np.abs(state - before)
        self.path += float((np.hypot(*moved[:, :2].T) + self.reach[who] * moved[:, 2]).max())
        for k, start, end in zip(who.tolist(), before.tolist(), state.tolist(), strict=True):
            mover, ways = self.movers[k], []
            for x, y, mover.angle in (start, end):
                mover.position = x, y
                ways.append([mover.local_to_world(middle_of(shape)) for shape in mover.shapes])
            self.space.reindex_shapes_for_body(mover)
            for way in zip(*ways, strict=True):
                if self.space.segment_query_first(*way, 0.0, WALLS_ALONE):
                    name = self.world.scenario.bodies[k].name
                    self.watch.escaped = f"{name}, {way[0]} to {way[1]}"
        for k in who.tolist():
            self.measure(k)

    def measure(self, k: int) -> None:
        """Measure how deep a body is in others, in walls, and beyond the room."""
        xmin, xmax, ymin, ymax = self.world.scenario.bounds
        for shape in self.movers[k].shapes:
            left, bottom, right, top = shape.cache_bb()
            beyond = max(xmin - left, ymin - bottom, right - xmax, top - ymax)
            self.watch.outside = max(self.watch.outside, beyond)
            for met in self.space.shape_query(shape):
                other = met.shape.filter.group - 1 if met.shape is not None else -1
                if other == k or frozenset((k, other)) in self.passing:
                    continue
                depth = max(-point.distance for point in met.contact_point_set.points)
                if depth > self.watch.deepest:
                    self.watch.deepest, self.watch.when = depth, self.world.iteration
                    self.watch.who = k, other

    def look_at(self, island: Island, _: float) -> None:
        """Look at an island after a substep."""
        self.count += 1
        self.look(np.array([body.number for body in island.bodies]), states_of(island.bodies))

    def tick(self, command: np.ndarray) -> None:
        """Let the world go on by a control step."""
        self.world.step(command)
        state = np.hstack([self.world.pose, self.world.prop_pose]).T
        self.look(np.arange(len(state)), state)


@contextmanager
def watched(world: World) -> Iterator[Watcher]:
    """Look at all that happens to a world that was made in Python."""
    watcher = Watcher(world)
    run, begin_again = Island.run, Mover.begin_again

    def counted(island: Island, duration: float, time: float) -> bool:
        watcher.count, watcher.path = 0, 0.0
        good = run(island, duration, time)
        watch = watcher.watch
        watch.substeps += watcher.count
        most = most_substeps(island, duration, watcher.path)
        watch.surplus = max(watch.surplus, watcher.count - most)
        return good

    def put_back(mover: Mover, body: Body) -> None:
        begin_again(mover, body)
        watcher.state[body.number] = states_of([body])[0]

    with pytest.MonkeyPatch.context() as patch, looked_at(watcher.look_at):
        patch.setattr(Island, "run", counted)
        patch.setattr(Mover, "begin_again", put_back)
        yield watcher


def rough(
    seed: int, mix: str, mass_ratio: float, sampling_time: float, ticks: int, *, ties=False,
    max_overlap: float = ALLOWED,
) -> Watch:  # fmt: skip
    """Let a crowd push at random; return what was seen."""
    scenario = crowd(seed, mix, mass_ratio, sampling_time, ties=ties)
    scenario = scenario.replace(max_overlap=max_overlap)
    with plainly():
        world = World(scenario)
    rng = np.random.default_rng(seed + 1)
    with watched(world) as watcher:
        for _ in range(ticks):
            command = rng.uniform(-2, 2, (2, 4))
            watcher.tick(command)
    return watcher.watch


RUNS = [
    (mix, mass_ratio, sampling_time)
    for mix in MIXES
    for mass_ratio in (1.0, 10.0)
    for sampling_time in (0.05, 0.5)
]


def check(watch: Watch) -> None:
    assert watch.substeps > 0
    assert watch.deepest <= ALLOWED
    # A sharp vertex in a corner of the room lies further beyond one wall than it is in either.
    assert watch.outside <= 3 * ALLOWED
    assert not watch.escaped
    assert watch.surplus <= 0


@pytest.mark.slow
@each_case("mix", MIXES)
@each_case(("mass_ratio", "sampling_time", "ticks"), [(1.0, 0.5, 2), (10.0, 0.05, 6)])
def test_in_a_crowd_of_many_shapes_nothing_overlaps_by_a_millimetre(
    mix, mass_ratio, sampling_time, ticks
):
    check(rough(1, mix, mass_ratio, sampling_time, ticks, ties=mass_ratio == 1))


@each_case(("max_overlap", "ticks"), [(1e-4, 4), (2e-2, 10)])
def test_the_overlap_stays_under_what_is_allowed(max_overlap, ticks):
    watch = rough(1, "discs", 1.0, 0.1, ticks, max_overlap=max_overlap)
    assert 0 < watch.deepest <= max_overlap


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(40))
@pytest.mark.parametrize("ties", [False, True])
def test_in_many_crowds_of_many_shapes_nothing_overlaps_by_a_millimetre(seed, ties):
    for mix, mass_ratio, sampling_time in RUNS:
        ticks = 40 if sampling_time < 0.1 else 8
        watch = rough(seed, mix, mass_ratio, sampling_time, ticks, ties=ties)
        try:
            check(watch)
        except AssertionError as error:
            error.add_note(f"{mix}, mass ratio {mass_ratio}, sampling time {sampling_time}")
            raise


# -- everything at once, and wildly ---------------------------------------------------------


def wild(seed: int) -> Scenario:
    """A crowd with numbers near the ends of what is allowed."""
    rng = np.random.default_rng(seed)
    scenario = crowd(seed, "everything", 10.0, float(rng.choice([0.01, 0.1, 1.0])), ties=True)
    force = float(10 ** rng.uniform(-6, 3))
    torque = float(10 ** rng.uniform(-6, 2))
    friction = float(rng.choice([0, 1, 1000]))
    speed = float(10 ** rng.uniform(-2, 1.5))
    robots = [
        robot.replace(
            drive=robot.drive.replace(max_force=force, max_torque=torque, max_linear_speed=speed),
            friction=friction,
        )
        for robot in scenario.robots
    ]
    props = [
        prop.replace(
            ground_friction=float(rng.choice([0, 1, 100])),
            velocity=tuple(rng.uniform(-1, 1, 3) * float(10 ** rng.uniform(-2, 1.5))),
        )
        for prop in scenario.props
    ]
    return scenario.replace(
        robots=robots, props=props, physics=str(rng.choice(["contact", "contact", "stop", "ideal"]))
    )


@pytest.mark.slow
@each_case("seed", range(1, 4))
def test_wild_crowds_do_not_end_in_nonsense(seed):
    world = World(wild(seed))
    rng = np.random.default_rng(seed)
    for _ in range(max(2, round(2.0 / world.scenario.sampling_time))):
        world.step(rng.uniform(-30, 30, (2, 4)))
        assert np.isfinite(world.pose).all()
        assert np.isfinite(world.prop_pose).all()
        assert np.isfinite(world.prop_velocity).all()
        assert all(np.isfinite(world.contacts[name]).all() for name in ("impulse", "speed", "slip"))
        assert ((world.effort >= 0) & (world.effort <= 1)).all()
