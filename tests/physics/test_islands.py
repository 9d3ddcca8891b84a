"""Who is in which island, what becomes of islands, and control steps that begin again."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import numpy as np
import pytest

from mars2d import Holonomic, Robot, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies.joints import Rope
from mars2d.bodies.props import Puck
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.island import Island
from mars2d.physics.islands.mover import Mover
from mars2d.physics.islands.solver import Solver
from tests.cases import each_case
from tests.islands import looked_at, plainly
from tests.worlds import endless

IDLE = Robot(pose=(50, 50, 0))
WEAK = Holonomic(max_force=1e-6, max_torque=1e-6)


class Seen:
    """What was seen of islands: those that were stepped, who began again, and who was carried."""

    def __init__(self) -> None:
        self.stepped: list[list[int]] = []
        self.failed: list[list[int]] = []
        self.again: list[int] = []
        self.carried: list[int] = []
        self.solved: list[int] = []  # how many bodies each step of a solver had


@contextmanager
def watched() -> Iterator[Seen]:
    """Gather what happens to islands in this block."""
    seen = Seen()
    run, carry, again, go = Island.run, Mover.carry, Mover.begin_again, Solver.go

    def run_island(island: Island, duration: float, time: float) -> bool:
        good = run(island, duration, time)
        (seen.stepped if good else seen.failed).append([body.number for body in island.bodies])
        return good

    def carried(mover: Mover, body: Body, duration: float) -> None:
        seen.carried.append(body.number)
        carry(mover, body, duration)

    def begin(mover: Mover, body: Body) -> None:
        seen.again.append(body.number)
        again(mover, body)

    def step(solver: Solver, h: float) -> None:
        seen.solved.append(len(solver.bodies))
        go(solver, h)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Island, "run", run_island)
        patch.setattr(Mover, "carry", carried)
        patch.setattr(Mover, "begin_again", begin)
        patch.setattr(Solver, "go", step)
        yield seen


def world_of(robots, props=(), joints=(), **fields) -> World:
    """A world without limits, in Python."""
    with plainly():
        return endless(robots, props, joints, **fields)


def mover_of(world: World) -> Mover:
    mover: Mover = world.simulation.engine._mover
    return mover


def stepped(world: World, command, ticks: int = 1) -> Seen:
    """Give the same command for some control steps; return what was seen."""
    with watched() as seen:
        for _ in range(ticks):
            world.step(command)
    return seen


# -- who is in which island -----------------------------------------------------------------


def test_those_that_may_touch_each_other_are_one_island_and_all_others_are_free():
    robots = [Robot(pose=(x, 0, 0)) for x in (0, 5, 0.32, 9, 5.33)]
    seen = stepped(world_of(robots), np.array([[0.4] * 5, [0] * 5]))
    assert seen.stepped == [[0, 2], [1, 4]]
    assert seen.carried == [3]


def test_where_nothing_can_touch_each_is_moved_once_however_long_the_control_step():
    walls = Map([[(3, -3), (3, 3)]])
    robots = [Robot(pose=(0, 0, 0)), Robot(pose=(0, 2, np.pi)), Robot(pose=(0, -2, 1))]
    for sampling_time in (0.01, 0.1, 1.0):
        world = world_of(robots, sampling_time=sampling_time, addons=[walls])
        seen = stepped(world, [[0.4, 0.4, 0.4], [1, 0, -1]])
        assert seen.carried == [0, 1, 2]
        assert seen.stepped == seen.solved == []


def test_more_overlap_allowed_means_fewer_substeps():
    robots, needed = [Robot(), Robot(pose=(0.5, 0, np.pi))], []
    for max_overlap in (1e-5, 1e-3, 1e-2):
        world = world_of(robots, max_overlap=max_overlap)
        needed.append(len(stepped(world, [[0.4, 0.4], [0, 0]], 20).solved))
    fine, usual, coarse = needed
    assert fine > 3 * usual
    assert usual > 1.5 * coarse


def test_a_taut_rope_makes_an_island_and_a_slack_one_does_not():
    robots = [Robot(), Robot(pose=(1, 0, 0))]
    taut = world_of(robots, joints=[Rope(a="robot0", b="robot1", length=1.0)])
    slack = world_of(robots, joints=[Rope(a="robot0", b="robot1", length=2.0)])
    assert stepped(taut, np.zeros((2, 2))).stepped == [[0, 1]]
    assert stepped(slack, np.zeros((2, 2))).carried == [0, 1]


def test_islands_are_stepped_by_themselves_as_finely_as_each_needs():
    robots = [Robot(pose=(x, 0, theta)) for x, theta in ((0, 0), (0.301, np.pi), (9, 0), (9.31, 0))]
    world = world_of(robots)
    stepped(world, np.array([[0.3, 0.3, 0, 0], [0] * 4]), 3)
    seen = stepped(world, np.array([[0.3, 0.3, 0.1, 0.1], [0] * 4]))
    assert seen.stepped == [[0, 1], [2, 3]]
    assert set(seen.solved) == {2}  # the two that only stay near each other need no solver
    exact = world.pose[:, 2]
    assert exact == pytest.approx([9.01, 0, 0], abs=1e-12)


# -- what becomes of islands ----------------------------------------------------------------


def bodies_of(mover: Mover) -> list[list[int]]:
    """Return who is in each solver that is in use."""
    return sorted(sorted(b.number for b in s.bodies) for s in mover.solvers if s.bodies)


def test_bodies_that_leave_an_island_leave_its_solver():
    world = world_of([Robot(), Robot(pose=(0.301, 0, np.pi)), Robot(pose=(0, 0.301, -np.pi / 2))])
    mover = mover_of(world)
    stepped(world, np.array([[0.2, 0.2, 0.2], [0, 0, 0]]), 3)
    assert bodies_of(mover) == [[0, 1, 2]]
    stepped(world, np.array([[0.2, 0.2, -0.4], [0, 0, 0]]), 10)
    assert bodies_of(mover) == [[0, 1]]
    assert mover.bodies[2].solver is None
    stepped(world, np.array([[-0.4, -0.4, -0.4], [0, 0, 0]]), 10)
    assert bodies_of(mover) == []
    assert len(mover.spare) == len(mover.solvers)


def test_two_islands_that_meet_become_one_and_keep_their_momentum():
    def pair(x: float, speed: float) -> list[Puck]:
        return [
            Puck(pose=(x + k * 0.201, 0, 0), velocity=(speed, 0, 0), ground_friction=0,
                 restitution=0.5, mass=1.0 + k, diameter=0.2)
            for k in range(2)
        ]  # fmt: skip

    pucks = [*pair(-0.7, 1.0), *pair(0.7, -0.5)]
    pucks[0] = pucks[0].replace(velocity=(1.2, 0, 0))
    pucks[3] = pucks[3].replace(velocity=(-0.9, 0, 0))
    world = world_of([IDLE], pucks)
    mass = np.array([1.0, 2.0, 1.0, 2.0])
    before = (mass * world.prop_velocity[0]).sum()
    seen = stepped(world, np.zeros((2, 1)), 20)
    assert [1, 2] in seen.stepped
    assert [3, 4] in seen.stepped
    assert [1, 2, 3, 4] in seen.stepped
    assert (mass * world.prop_velocity[0]).sum() == pytest.approx(before, abs=1e-12)
    assert (np.diff(world.prop_pose[0]) > 0.2 - 1e-3).all()
    assert bodies_of(mover_of(world)) == []


# -- control steps that begin again ---------------------------------------------------------


def throw(sampling_time: float, *others: Robot, **fields) -> tuple[World, Seen]:
    """A heavy elastic robot hits a light one, in one control step or in many; 2 s in all."""
    heavy = Robot(pose=(-0.4, 0, 0), mass=10, restitution=1, drive=WEAK, friction=0)
    light = Robot(restitution=1, drive=WEAK, friction=0)
    world = world_of([heavy, light, *others], sampling_time=sampling_time, **fields)
    command = np.zeros((2, 2 + len(others)))
    command[0, 0] = 0.5
    return world, stepped(world, command, round(2 / sampling_time))


def test_a_body_that_is_thrown_further_than_thought_begins_again():
    world, seen = throw(2.0)
    assert seen.failed == [[0, 1]]
    assert sorted(seen.again) == [0, 1]
    assert seen.stepped == [[0, 1]]
    _, often = throw(0.01)
    assert often.failed in ([], [[0, 1]])
    assert world.contacts["began"].sum() == 1


def test_what_began_again_ends_where_short_control_steps_lead_to():
    long, _ = throw(2.0)
    short, _ = throw(0.01)
    assert long.pose == pytest.approx(short.pose, abs=2e-3)
    assert long.velocity == pytest.approx(short.velocity, abs=1e-4)
    assert long.velocity[0] == pytest.approx([0.5 * 9 / 11, 0.5 * 20 / 11], rel=1e-3)
    assert long.effort == pytest.approx(short.effort, abs=1e-9)


def test_nor_are_those_that_went_on_from_before():
    """The light one leans on a wall when it is hit: that contact goes on, once."""
    wall = Map([[(-0.1, -0.1501), (1, -0.1501)]], friction=0, restitution=0)
    heavy = Robot(pose=(-0.45, 0, 0), mass=10, restitution=1, friction=0, drive=WEAK)
    weak = Unicycle(max_force=0.1)
    light = Robot(pose=(0, 0, -np.pi / 2), restitution=1, friction=0, drive=weak)
    world = world_of([heavy, light], sampling_time=1.0, addons=[wall])
    stepped(world, [[0.1, 0.1], [0, 0]])
    assert world.contacts[["a", "b"]].tolist() == [(1, -1)]
    seen = stepped(world, [[0.8, 0.1], [0, 0]])
    assert seen.failed
    rows = world.contacts
    pressed = rows[(rows["a"] == 1) & (rows["b"] == -1)]
    assert len(pressed) == 1
    assert not pressed["began"].any()
    assert pressed["time"] == pytest.approx([1.0])
    assert pressed["duration"][0] <= 1.0 + 1e-9
    assert 0 < pressed["normal_impulse"][0] <= 0.1 * 1.0 + 1e-9  # what its drive can do
    assert rows["began"][(rows["a"] == 0) & (rows["b"] == 1)].tolist() == [True]


def test_what_is_hit_by_one_that_was_thrown_further_than_thought_joins_in():
    """It was in no island at first, or in another one, which is begun again as well."""
    far = Robot(pose=(1.7, 0, 0), restitution=1, drive=WEAK, friction=0)
    further = far.at(2.01, 0, 0)
    world, seen = throw(2.0, far, further)
    short, _ = throw(0.01, far, further)
    assert [0, 1] in seen.failed
    assert [0, 1, 2, 3] in seen.stepped
    mass = np.array([10.0, 1, 1, 1])
    assert (mass * world.velocity[0]).sum() == pytest.approx(5.0, abs=1e-4)  # drives hardly pull
    assert world.velocity == pytest.approx(short.velocity, abs=2e-3)
    assert world.pose == pytest.approx(short.pose, abs=5e-3)
    x = world.pose[0]
    assert (np.diff(x) > 0.3 - 1e-3).all()
    rows, others = world.contacts, short.record.contacts
    pushed = others["normal_impulse"] > 0  # not one that only tells that a touch has ended
    assert rows["normal_impulse"] == pytest.approx(others["normal_impulse"][pushed], rel=0.01)
    pairs = list(zip(rows["a"].tolist(), rows["b"].tolist(), strict=True))
    assert len(pairs) == len(set(pairs))


def test_a_robot_that_slipped_and_follows_again_moves_once_while_others_begin_again():
    """Two have bounced off each other; in the next control step their drives catch them."""
    bouncing = Robot(restitution=1, friction=0, drive=Holonomic(max_force=0.05))
    pair = [bouncing.at(0, 20, 0), bouncing.at(0.4, 20, 0)]
    heavy = Robot(pose=(-0.4, 0, 0), mass=10, restitution=1, drive=WEAK, friction=0)
    light = Robot(restitution=1, drive=WEAK, friction=0)
    alone, both = (world_of([*pair, *more], sampling_time=2.0) for more in ([], [heavy, light]))
    approach, apart = np.array([[0.25, -0.25], [0, 0]]), np.array([[-0.15, 0.15], [0, 0]])
    stepped(alone, approach)
    stepped(both, np.hstack([approach, np.zeros((2, 2))]))
    slipping = [body.slips for body in mover_of(both).bodies]
    stepped(alone, apart)
    seen = stepped(both, np.hstack([apart, [[0.5, 0], [0, 0]]]))
    assert slipping == [True, True, False, False]
    assert seen.failed == [[2, 3]]
    assert not any(body.slips for body in mover_of(both).bodies[:2])
    assert both.pose[:, :2].tolist() == alone.pose.tolist()


# -- many that push -----------------------------------------------------------------------------


def heap(n: int, heavy: float = 1.0) -> tuple[World, np.ndarray]:
    """Robots in a square that all drive to its middle, and their commands; each other is heavy."""
    wide = int(np.sqrt(n))
    places = [(0.32 * (k % wide), 0.32 * (k // wide)) for k in range(n)]
    x, y = (np.array(places) - np.mean(places, axis=0)).T
    robots = [
        Robot(pose=(*place, 0), drive=Holonomic(), mass=heavy if k % 2 else 1.0)
        for k, place in enumerate(zip(x, y, strict=True))
    ]
    return world_of(robots, sampling_time=0.1), -0.4 * np.array([x, y]) / np.hypot(x, y)


def file(n: int) -> tuple[World, np.ndarray]:
    """Robots one behind the other that drive against a wall, and their commands."""
    wall = Map([[(0, -1), (0, 1)]])
    robots = [Robot(pose=(-0.155 - 0.305 * k, 0, 0), drive=Holonomic()) for k in range(n)]
    command = np.array([[1.0], [0.0]]) * np.ones((2, n))
    return world_of(robots, sampling_time=0.1, addons=[wall]), command


@each_case(
    ("crowd", "n", "most"), [(heap, 16, 7), (partial(heap, heavy=10.0), 25, 12), (file, 12, 7)]
)
def test_pushes_add_up_to_no_more_overlap_and_to_few_more_substeps(crowd, n, most):
    """As many as a heap needs, where a file of as many robots would need more."""
    deepest, count = 0.0, 0

    def look(island: Island, h: float) -> None:
        nonlocal deepest, count
        if len(island.bodies) > n / 2:
            deepest, count = max(deepest, island.deepest), count + 1

    world, command = crowd(n)
    with looked_at(look):
        stepped(world, command, 40)
    assert 0 < deepest < 1e-3
    assert count <= most * 40


@each_case("seed", range(2))
def test_in_crowds_that_are_thrown_about_momentum_is_kept_and_nothing_overlaps(seed):
    """On each of eight ways to the middle a heavy elastic puck hits a light one."""
    rng = np.random.default_rng(seed)
    pucks = []
    for angle in np.arange(8) * np.pi / 4 + rng.uniform(-0.05, 0.05, 8):
        c, s = np.cos(angle), np.sin(angle)
        puck = Puck(diameter=0.2, restitution=1, ground_friction=0, mass=1)
        heavy = puck.replace(mass=10.0, velocity=(-c, -s, 0))
        pucks += [heavy.at(1.5 * c, 1.5 * s, 0), puck.at(1.2 * c, 1.2 * s, 0)]
    world = world_of([IDLE], pucks, sampling_time=1.0)
    mass = np.array([puck.inertia.mass for puck in pucks])
    before = (mass * world.prop_velocity[:2]).sum(axis=1)
    energy = (mass * (world.prop_velocity[:2] ** 2).sum(axis=0)).sum()
    seen = Seen()
    for _ in range(6):
        more = stepped(world, np.zeros((2, 1)))
        seen.failed += more.failed
        place = world.prop_pose[0] + 1j * world.prop_pose[1]
        assert (np.abs(place[:, None] - place) + np.eye(16)).min() > 0.2 - 1e-3
    assert seen.failed
    assert (mass * world.prop_velocity[:2]).sum(axis=1) == pytest.approx(before, abs=1e-10)
    after = (mass * (world.prop_velocity**2)[:2].sum(axis=0)).sum()
    assert after <= energy * (1 + 1e-6)
