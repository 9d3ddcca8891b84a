"""What is compiled does what its lines do in Python, to the last bit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import hypot, pi

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import mars2d
from mars2d import Holonomic, MaterialPair, Record, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Car, Differential, Drive
from mars2d.bodies.joints import Hinge, Joint, Rope, Spring
from mars2d.bodies.props import Ball, Box, Puck
from mars2d.core.materials import RULES
from mars2d.geometry.shapes import Polygon
from mars2d.physics import islands
from mars2d.physics.islands.mover import Mover
from mars2d.sensors import Bumper, Proximity, RangeFinder, Sensor
from tests.cases import each_case
from tests.islands import plainly
from tests.physics import test_crowd_fuzz as fuzz

WITHOUT = islands.reason_without()
pytestmark = pytest.mark.skipif(bool(WITHOUT), reason=f"nothing is compiled: {WITHOUT}")

Law = Callable[[World], np.ndarray]

ELL = [(0.0, 0.0), (0.3, 0.0), (0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0.0, 0.3)]
WEDGE = [(-0.12, -0.1), (0.15, 0.0), (-0.12, 0.1)]


def twins(scenario: Scenario, law: Law | None, seed: int = 0) -> tuple[World, World]:
    """The same world twice, compiled and in Python."""
    quick = World(scenario, law, seed)
    with plainly():
        slow = World(scenario, law, seed)
        assert slow.simulation.engine.space is not None  # rays, too: made when they are first asked
    assert [type(each.simulation.engine._mover) is Mover for each in (quick, slow)] == [False, True]
    return quick, slow


def assert_same(quick: World, slow: World) -> None:
    """All that a law could see of a world is the same, to the last bit."""
    names = "pose", "velocity", "prop_pose", "prop_velocity", "effort"
    ours, theirs = (
        {name: getattr(world, name) for name in names}
        | {name: world.contacts[name] for name in world.contacts.dtype.names}
        for world in (quick, slow)
    )
    for name, array in theirs.items():  # bytes: zero is not minus zero
        assert ours[name].tobytes() == array.tobytes(), f"{name} at {slow.time} s"


def run_both(scenario: Scenario, law: Law | None, ticks: int, seed: int = 0) -> Record:
    """Step both worlds, and compare after each tick; returns the record."""
    quick, slow = twins(scenario, law, seed)
    for _ in range(ticks):
        if not slow.over:  # somebody has left the workspace
            quick.step()
            slow.step()
            assert_same(quick, slow)
    assert quick.over_message == slow.over_message
    assert quick.record.digest == slow.record.digest
    return quick.record


# -- worlds of all kinds --------------------------------------------------------------------


def random_drive(rng: np.random.Generator, *, faults: bool) -> Drive:
    limits = {
        "max_linear_speed": rng.uniform(0.3, 3.0), "max_force": rng.uniform(1.0, 10.0),
        "max_torque": rng.uniform(0.1, 1.0),
    }  # fmt: skip
    if faults:
        limits |= {
            "noise": rng.uniform(0, 0.3), "dead_time": rng.uniform(0, 0.13),
            "max_acceleration": rng.uniform(1.0, 20.0), "force_limited": bool(rng.integers(2)),
        }  # fmt: skip
    kind: type[Drive] = rng.choice([Unicycle, Differential, Holonomic, Car])
    return kind(**limits)


def placed(rng: np.random.Generator, radii: Sequence[float], half: float, gap: float) -> np.ndarray:
    """Places (n, 2) of discs in a square, one touching another (gap 0) where there is room."""
    places: list[tuple[float, float]] = []
    for r in radii:
        for attempt in range(4000):
            if places and attempt % 2:
                k = int(rng.integers(len(places)))
                angle, far = rng.uniform(0, 2 * pi), radii[k] + r + gap
                x, y = np.add(places[k], [far * np.cos(angle), far * np.sin(angle)])
            else:
                x, y = rng.uniform(-1, 1, 2) * (half - r)
            inside = max(abs(x), abs(y)) <= half - r - gap
            others = zip(places, radii, strict=False)
            if inside and all(hypot(x - p, y - q) >= r + s + gap - 1e-12 for (p, q), s in others):
                places.append((float(x), float(y)))
                break
        else:
            raise AssertionError("no room")
    return np.array(places)


def obstacles(rng: np.random.Generator, half: float) -> list[list[tuple[float, float]]]:
    """A wall, a box, a concave one, one of many edges, outside of the square or beside it."""
    turns = np.linspace(0, 2 * pi, 40, endpoint=False)
    round_one = [(half + 1.2 + np.cos(a), np.sin(a)) for a in turns.tolist()]
    box = [(-half - 0.4, -0.2), (-half - 0.1, -0.2), (-half - 0.1, 0.2), (-half - 0.4, 0.2)]
    ell = [(x, y + half + 0.1) for x, y in ELL]
    wall = [(-half, -half - 0.15), (float(rng.uniform(0, half)), -half - 0.05)]
    return [wall, box, ell, round_one]


def crowd(
    seed: int, n: int, *, cover: float = 0.3, gap: float = 0.01, faults: bool = False,
    things: bool = False, sensors: Sequence[Sensor] = (), **fields: object,
) -> Scenario:  # fmt: skip
    """A room with n bodies of all drives, sizes, masses and surfaces, some almost in touch.

    things: whether a third of them are props, some are polygons, and four are tied.
    """
    rng = np.random.default_rng(seed)
    radii = rng.uniform(0.1, 0.3, n)
    half = max(float(np.sqrt(pi * (radii**2).sum() / cover)) / 2, 0.7)
    places = placed(rng, radii.tolist(), half, gap)
    elastic, rough = rng.choice([0.0, 0.5, 1.0], 2)
    drives = [random_drive(rng, faults=faults) for _ in range(min(n, 5))]
    robots, props = [], []
    for i, (place, r) in enumerate(zip(places.tolist(), radii.tolist(), strict=True)):
        common = {
            "pose": (*place, rng.uniform(-3, 3)), "mass": float(rng.uniform(0.7, 3.0)),
            "friction": rough, "restitution": elastic,
        }  # fmt: skip
        robot = Robot(diameter=2 * r, drive=drives[i % len(drives)], sensors=sensors, **common)
        if things and i % 3 == 1:
            props.append(
                Ball(diameter=2 * r, **common) if i % 2 else Box(length=1.3 * r, width=r, **common)
            )
        elif things and i % 3 == 2:
            shape = Polygon([(4 * r * x, 4 * r * y) for x, y in WEDGE])
            lead = float(rng.uniform(-0.5, 0.5) * r)
            robots.append(Robot(shape=shape, drive=robot.drive, mass_offset=lead, **common))
        else:
            robots.append(robot)
    joints = []
    if things and len(robots) > 3:
        joints = [Spring(a="robot0", b="robot1"), Rope(a="robot2", b="robot3")]
    room = half + 0.6
    return Scenario(
        robots=robots,
        props=props,
        joints=joints,
        workspace=[(-room, -room), (room + 1.8, -room), (room + 1.8, room + 0.2), (-room, room)],
        addons=[Map(obstacles(rng, half), friction=0.7, restitution=0.9)],
        stop_time=1e6 * fields.get("sampling_time", 0.1),
        **{"on_exit": "wall", **fields},
    )


def dampers(seed: int) -> Scenario:
    """Two robots that draw two boxes each, by a spring and a hinge with one; all are damped."""
    rng = np.random.default_rng(seed)
    joints: list[Joint] = []
    for k in range(2):
        stiffness, damping, twist, slow = rng.uniform([5, 1, 0.5, 0.2], [100, 100, 20, 20]).tolist()
        joints += [
            Spring(a=f"robot{k}", b=f"box{2 * k}", stiffness=stiffness, damping=damping),
            Hinge(
                a=f"box{2 * k}", b=f"box{2 * k + 1}", anchor_a=(-0.3, 0), anchor_b=(0.3, 0),
                stiffness=twist, damping=slow,
            ),
        ]  # fmt: skip
    return Scenario(
        robots=[Robot(pose=(1, y, 0)) for y in (-1, 1)],
        props=[Box(length=0.4, width=0.3, pose=(x, y, 0)) for y in (-1, 1) for x in (0, -0.6)],
        joints=joints,
        stop_time=1e3,
    )


def restless(seed: int, scenario: Scenario) -> Law:
    """Commands that change now and then: ahead, back, turning."""
    n = len(scenario.robots)
    draws = np.random.default_rng(seed).uniform(-1, 1, (40, 2, n)) * [[2.0], [3.0]]
    return lambda world: draws[world.iteration // 3 % len(draws)]


@pytest.mark.slow
@given(
    seed=st.integers(0, 2**32),
    n=st.integers(1, 20),
    max_overlap=st.sampled_from([1e-3, 5e-3, 0.02]),
    sampling_time=st.sampled_from([0.01, 0.05, 0.1, 0.37, 1.0]),
    delay=st.sampled_from([0.0, 0.03, 0.1, 0.237]),
    faults=st.booleans(),
    things=st.booleans(),
    gap=st.sampled_from([0.0, 1e-6, 0.02]),
    on_exit=st.sampled_from(["wall", "stop", "ignore"]),
    physics=st.sampled_from(["contact", "contact", "stop", "ideal"]),
)
@example(0, 1, 1e-3, 0.1, 0.0, False, False, 0.02, "wall", "contact")
@example(5, 6, 1e-4, 0.1, 0.0, True, True, 0.0, "wall", "contact")
@example(1, 32, 0.02, 0.1, 0.03, True, False, 0.0, "wall", "contact")
@example(2, 33, 0.02, 0.1, 0.03, True, True, 0.0, "wall", "contact")
@settings(max_examples=12)
def test_a_crowd_moves_the_same_with_and_without(
    seed, n, max_overlap, sampling_time, delay, faults, things, gap, on_exit, physics
):
    scenario = crowd(
        seed, n, gap=gap, faults=faults, things=things, max_overlap=max_overlap,
        sampling_time=sampling_time, command_delay=delay, on_exit=on_exit, physics=physics,
    )  # fmt: skip
    run_both(scenario, restless(seed, scenario), 2 if sampling_time > 0.3 else 5, seed)


@each_case(("n", "things"), [(3, False), (36, True)])
def test_sensors_find_bodies_where_they_are(n, things):
    """Rays and points are asked between the steps, when bodies have been put somewhere."""
    sensors = [RangeFinder(beams=16, range=2.0), Proximity(range=0.2), Bumper()]
    scenario = crowd(n, n, gap=0.0, things=things, sensors=sensors, max_overlap=0.02)
    record = run_both(scenario, restless(n, scenario), 10)
    assert len(record.contacts) > 0


def test_robots_far_apart_and_alone():
    """A few are kilometres and a thousand kilometres away; what lies between is not kept."""
    near = [Robot(pose=(0.5 * (i % 7), 0.5 * (i // 7), i)) for i in range(40)]
    far = [Robot(pose=(x, 0.3, 0)) for x in (-1e6, -1e3, -1e3 + 0.31, 1e3, 1e6)]
    scenario = Scenario(robots=[*near, *far], workspace=None, sampling_time=0.5, stop_time=1e3)
    record = run_both(scenario, restless(3, scenario), 12)
    assert {40 + 1, 40 + 2} <= {*record.contacts["a"].tolist(), *record.contacts["b"].tolist()}


# -- props, joints, polygons, and motion without forces -------------------------------------


@each_case("ties", [False, True])
@each_case("mix", fuzz.MIXES)
def test_so_does_a_crowd_of_many_shapes(mix, ties):
    scenario = fuzz.crowd(1, mix, 10.0, 0.05, ties=ties)
    record = run_both(scenario, restless(1, scenario), 8)
    assert len(record.contacts) > 1


@pytest.mark.slow
@each_case("seed", [1, 3])
def test_so_do_wild_crowds(seed):
    scenario = fuzz.wild(seed)
    run_both(scenario, restless(seed, scenario), 4)


@each_case("rule", RULES)
def test_so_does_one_of_many_surfaces(rule):
    """Rules, pairs of materials, and static friction of bodies, obstacles and the floor."""
    scenario = crowd(RULES.index(rule), 24, gap=0.0, things=True)
    names = ["rubber", "ice", 0.4, "steel"]
    robots = [
        robot.replace(friction=names[i % 4], static_friction=None if i % 3 else 1.1 + 0.1 * i)
        for i, robot in enumerate(scenario.robots)
    ]
    props = [
        prop.replace(friction=names[i % 4], restitution=names[i % 4], static_ground_friction=0.9)
        for i, prop in enumerate(scenario.props)
    ]
    pairs = [
        MaterialPair("rubber", "ice", friction=0.05, static_friction=0.2),
        MaterialPair("steel", "steel", friction=0.57, static_friction=0.74, restitution=0.9),
    ]
    chart = scenario.addons[0].replace(friction="ice", static_friction=0.6)
    mixed = scenario.replace(
        robots=robots, props=props, addons=[chart], material_pairs=pairs, friction_rule=rule,
        restitution_rule=RULES[(RULES.index(rule) + 2) % 5],
    )  # fmt: skip
    record = run_both(mixed, restless(3, mixed), 6)
    assert len(record.contacts) > 5


@each_case("seed", range(2))
def test_so_do_springs_with_dampers(seed):
    scenario = dampers(seed)
    run_both(scenario, restless(seed, scenario), 15)


@each_case("physics", ["stop", "ideal"])
def test_so_does_one_without_forces(physics):
    scenario = fuzz.crowd(2, "everything", 1.0, 0.1, ties=True).replace(physics=physics)
    record = run_both(scenario, restless(2, scenario), 10)
    assert len(record.contacts) > 5


def test_so_does_one_that_is_pulled_about():
    def pulled(world: World) -> str:
        for k in range(12):
            world.operator.pull(2, (0.02, 0.05), (np.sin(k / 3), np.cos(k / 3)), force=20.0)
            if k == 8:
                world.operator.pull(4, (0.0, 0.0), (0.5, 0.5), force=5.0)
            world.step(np.zeros((2, 4)))
        world.break_off("enough")
        return world.record.digest

    quick, slow = twins(fuzz.crowd(5, "everything", 1.0, 0.05, ties=True), None)
    assert pulled(quick) == pulled(slow)


@pytest.mark.parametrize(
    ("n", "ticks"),
    [(2, 40), (50, 6), pytest.param(200, 5, marks=pytest.mark.slow),
     pytest.param(1000, 4, marks=pytest.mark.nightly)],
)  # fmt: skip
def test_so_do_few_and_many_bodies(n, ticks):
    scenario = crowd(n, n, gap=0.0, things=True)
    record = run_both(scenario, restless(n, scenario), ticks)
    assert n == 2 or len(record.contacts) > n / 2


@each_case("name", ["follow_the_leader", "shove_and_spin", "sumo"])  # the quick ones
def test_an_example_is_the_same_with_and_without(name):
    quick = mars2d.run(name)
    with plainly():
        slow = mars2d.run(name)
    assert quick.digest == slow.digest
    assert np.array_equal(quick.effort, slow.effort)
    assert np.array_equal(quick.contacts, slow.contacts)


@given(
    theta=st.floats(-1e6, 1e6), omega=st.floats(-30, 30), h=st.floats(1e-3, 20),
    v=st.floats(-1, 1), offset=st.floats(-0.1, 0.1),
)  # fmt: skip
def test_arcs_are_the_same_whatever_the_angle(theta, omega, h, v, offset):
    robot = Robot(pose=(0, 0, theta), center_offset=offset, drive=Unicycle(max_linear_speed=1))
    scenario = Scenario(robots=[robot], workspace=None, sampling_time=h, stop_time=1e3)
    run_both(scenario, lambda _: np.array([[v], [omega]]), 2)


speeds = st.floats(-20, 20)


@given(
    vx=speeds, vy=speeds, spin=st.one_of(speeds, st.just(0.0)), mu=st.floats(0, 1),
    moment=st.floats(1e-3, 0.01), h=st.floats(1e-3, 5),
)  # fmt: skip
def test_glides_are_the_same_whatever_the_friction(vx, vy, spin, mu, moment, h):
    puck = Puck(pose=(5, 5, 0), velocity=(vx, vy, spin), ground_friction=mu, moment=moment)
    scenario = Scenario(
        robots=[Robot()], props=[puck], workspace=None, sampling_time=h, stop_time=1e4
    )
    run_both(scenario, lambda _: np.zeros((2, 1)), 2)
