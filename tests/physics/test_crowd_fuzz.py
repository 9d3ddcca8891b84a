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
from pymunk._chipmunk_cffi import lib

from mars2d import Holonomic, Robot, Scenario, Unicycle, World
from mars2d.bodies.joints import Hinge, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Prop, Puck, Solid
from mars2d.core.plane import edges_of
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.island import Island
from mars2d.physics.islands.mover import Mover
from tests.cases import each_case
from tests.islands import FIND_TESTS, looked_at, plainly, states_of

ALLOWED = 1e-3  # metres, the default of Scenario.max_overlap

ELL = Polygon([(0, 0), (0.3, 0), (0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0, 0.3)])
DUMBBELL = Compound([Disc(0.12).moved(-0.1, 0), Disc(0.12).moved(0.1, 0)])
WEDGE = Polygon([(-0.12, -0.1), (0.15, 0), (-0.12, 0.1)])

Maker = Callable[[np.random.Generator, dict], Robot | Prop]


def disc_robot(rng: np.random.Generator, looks: dict) -> Robot:
    drive = (Unicycle, Holonomic)[int(rng.integers(2))](max_linear_speed=2.0)
    return Robot(diameter=rng.uniform(0.15, 0.3), drive=drive, **looks)


def box_robot(rng: np.random.Generator, looks: dict) -> Robot:
    x, y = rng.uniform(0.08, 0.15, 2)
    drive = (Unicycle, Holonomic)[int(rng.integers(2))](max_linear_speed=2.0)
    return Robot(shape=Polygon([(-x, -y), (x, -y), (x, y), (-x, y)]), drive=drive, **looks)


def wedge_robot(rng: np.random.Generator, looks: dict) -> Robot:
    offset = rng.uniform(-0.1, 0.1)
    return Robot(shape=WEDGE, center_offset=offset, drive=Unicycle(max_linear_speed=2.0), **looks)


def box(rng: np.random.Generator, looks: dict) -> Prop:
    length, width = rng.uniform(0.1, 0.35, 2)
    return Box(length=length, width=width, ground_friction=rng.uniform(0, 0.6), **looks)


def bar(rng: np.random.Generator, looks: dict) -> Prop:
    return Bar(
        length=rng.uniform(0.3, 0.6), thickness=0.04, ground_friction=rng.uniform(0, 0.3), **looks
    )


def ball(rng: np.random.Generator, looks: dict) -> Prop:
    return Ball(diameter=rng.uniform(0.1, 0.25), **looks)


def puck(rng: np.random.Generator, looks: dict) -> Prop:
    return Puck(diameter=rng.uniform(0.1, 0.25), **looks)


def ell(rng: np.random.Generator, looks: dict) -> Prop:
    return Solid(ELL, ground_friction=rng.uniform(0, 0.3), **looks)


def dumbbell(rng: np.random.Generator, looks: dict) -> Prop:
    return Solid(DUMBBELL, ground_friction=0.0, **looks)


MIXES: dict[str, list[Maker]] = {
    "discs": [disc_robot, ball, puck],
    "polygons": [box_robot, wedge_robot, box, bar, ell],
    "everything": [disc_robot, box_robot, wedge_robot, box, bar, ball, puck, ell, dumbbell],
}


def crowd(seed: int, mix: str, mass_ratio: float, sampling_time: float, *, ties: bool) -> Scenario:
    """A room with four robots and eight props at random, and joints between some of them."""
    rng = np.random.default_rng(seed)
    makers = MIXES[mix]
    robots = [maker for maker in makers if maker.__name__.endswith("robot")]
    props = [maker for maker in makers if not maker.__name__.endswith("robot")]
    restitution = rng.choice([0.0, 0.5, 1.0])
    bodies: list[Robot | Prop] = []
    for i in range(12):
        make = (robots if i < 4 else props)[int(rng.integers(len(robots if i < 4 else props)))]
        looks = {
            "mass": mass_ratio ** float(rng.integers(3) / 2),
            "friction": float(rng.choice([0.0, 0.5, 1.0])),
            "restitution": float(restitution),
        }
        body = make(rng, looks)
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


def depth_of(a: pymunk.Shape, b: pymunk.Shape) -> float:
    """How deep two shapes overlap, metres; pymunk's own wrapper fails where they do not."""
    found = lib.cpShapesCollide(a._shape, b._shape)
    return max((-found.points[k].distance for k in range(found.count)), default=0.0)


def shapes_of(scenario: Scenario) -> tuple[list[pymunk.Body], list[tuple[int, pymunk.Shape]]]:
    """Return all bodies in pymunk, the ground last, and all shapes with their numbers, or -1."""
    movers, shapes = [], []
    for i, rigid in enumerate(scenario.bodies):
        movers.append(pymunk.Body(1.0, 1.0))
        for vertices, radius in rigid.shape.pieces:
            if len(vertices) == 1:
                shapes.append((i, pymunk.Circle(movers[i], radius, vertices[0])))
            else:
                shapes.append((i, pymunk.Poly(movers[i], vertices)))
    ground = pymunk.Body(body_type=pymunk.Body.STATIC)
    edges = [edge for surface in scenario.surfaces for edge in edges_of(surface.outline)]
    movers.append(ground)  # shapes do not keep their bodies alive
    return movers, shapes + [(-1, pymunk.Segment(ground, *edge, 0.0)) for edge in edges]


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


def places_of(points: list[tuple[float, float]], poses: np.ndarray) -> np.ndarray:
    """Return where points of bodies at poses (k, 3) are, (k, 2)."""
    x, y = np.array(points).T
    c, s = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    return np.column_stack([poses[:, 0] + c * x - s * y, poses[:, 1] + s * x + c * y])


def cross(start: np.ndarray, end: np.ndarray, walls: np.ndarray) -> np.ndarray:
    """Return which ways from points (k, 2) to others cross which walls (m, 4), (k, m)."""

    def side(a: np.ndarray, b: np.ndarray, point: np.ndarray) -> np.ndarray:
        way, to = b - a, point - a
        return way[..., 0] * to[..., 1] - way[..., 1] * to[..., 0]

    p, q, a, b = start[:, None], end[:, None], walls[:, :2], walls[:, 2:]
    return (side(a, b, p) * side(a, b, q) < 0) & (side(p, q, a) * side(p, q, b) < 0)


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
        """Make all shapes once more."""
        self.world, self.watch = world, Watch()
        scenario = world.scenario
        self.movers, self.shapes = shapes_of(scenario)
        self.owner = np.array([i for i, _ in self.shapes])
        self.moving = int((self.owner >= 0).sum())
        self.middles = [middle_of(shape) for _, shape in self.shapes[: self.moving]]
        ends = [(*shape.a, *shape.b) for _, shape in self.shapes[self.moving :]]
        self.walls = np.array(ends).reshape(-1, 4)
        self.reach = np.array([body.shape.reach for body in scenario.bodies])
        i, j = np.triu_indices(len(self.shapes), 1)
        passing = {*scenario.joined}
        pairs = self.owner[i] != self.owner[j]
        pairs &= np.array(
            [(a, b) not in passing for a, b in zip(self.owner[i], self.owner[j], strict=True)], bool
        )
        self.i, self.j = i[pairs], j[pairs]
        self.state = np.hstack([world.pose, world.prop_pose]).T
        self.count, self.path = 0, 0.0

    def look(self, who: np.ndarray, state: np.ndarray) -> None:
        """Look at some bodies, which are at `state` now, (k, 3)."""
        assert np.isfinite(state).all()
        before, self.state[who] = self.state[who], state
        moved = np.abs(state - before)
        self.path += float((np.hypot(*moved[:, :2].T) + self.reach[who] * moved[:, 2]).max())
        owner = self.owner[: self.moving]
        where = np.zeros((len(self.movers), 3))
        where[who] = before
        start = places_of(self.middles, where[owner])
        where[who] = state
        end = places_of(self.middles, where[owner])
        for p, q in np.argwhere(cross(start, end, self.walls)).tolist():
            way = f"{start[p].tolist()} to {end[p].tolist()}"
            name = self.world.scenario.bodies[owner[p]].name
            self.watch.escaped = f"{name}, {way}, wall {self.walls[q]}"
        self.find_overlaps(who)

    def find_overlaps(self, who: np.ndarray) -> None:
        """Measure how deep some bodies are in each other, in walls, and beyond the room."""
        for k in who.tolist():
            x, y, angle = self.state[k].tolist()
            self.movers[k].position, self.movers[k].angle = (x, y), angle
        boxes = np.array([shape.cache_bb() for _, shape in self.shapes])  # left, bottom, right, top
        here = np.isin(self.owner, who)
        left, bottom, right, top = boxes[here].T
        xmin, xmax, ymin, ymax = self.world.scenario.bounds
        beyond = [xmin - left, ymin - bottom, right - xmax, top - ymax]
        self.watch.outside = max(self.watch.outside, float(np.max(beyond)))
        here |= self.owner < 0
        i, j = self.i, self.j
        meet = here[i] & here[j]
        meet &= (boxes[i, :2] < boxes[j, 2:]).all(axis=1) & (boxes[j, :2] < boxes[i, 2:]).all(
            axis=1
        )
        for p, q in zip(i[meet].tolist(), j[meet].tolist(), strict=True):
            depth = depth_of(self.shapes[p][1], self.shapes[q][1])
            if depth > self.watch.deepest:
                self.watch.deepest, self.watch.when = depth, self.world.iteration
                self.watch.who = int(self.owner[p]), int(self.owner[q])

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


@each_case("max_overlap", [1e-4, 2e-2])
def test_the_overlap_stays_under_what_is_allowed(max_overlap):
    watch = rough(1, "discs", 1.0, 0.1, 10, max_overlap=max_overlap)
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


def run_wildly(seed: int, seconds: float = 2.0) -> None:
    """Run a wild crowd; raises AssertionError where something is not finite."""
    world = World(wild(seed))
    rng = np.random.default_rng(seed)
    for _ in range(max(2, round(seconds / world.scenario.sampling_time))):
        world.step(rng.uniform(-30, 30, (2, 4)))
        assert np.isfinite(world.pose).all()
        assert np.isfinite(world.prop_pose).all()
        assert np.isfinite(world.prop_velocity).all()
        assert all(np.isfinite(world.contacts[name]).all() for name in ("impulse", "speed", "slip"))
        assert ((world.effort >= 0) & (world.effort <= 1)).all()


def in_a_child(child, seeds: range, timeout: float):
    code = FIND_TESTS + (
        f"import runpy; tests = runpy.run_path({__file__!r})\n"
        f"for seed in {seeds!r}: print(seed, flush=True); tests['run_wildly'](seed)"
    )
    return child(code, timeout=timeout)


@pytest.mark.slow
def test_wild_crowds_end_neither_the_process_nor_in_nonsense(child):
    done = in_a_child(child, range(1, 4), 120)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.nightly
@pytest.mark.parametrize("first", range(0, 100, 5))
def test_many_wild_crowds_end_neither_the_process_nor_in_nonsense(child, first):
    done = in_a_child(child, range(first, first + 5), 600)
    assert done.returncode == 0, done.stdout + done.stderr
