"""The kernel in C does what the plain engine does, to the last bit; that is its oracle."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from math import hypot, pi

import cffi
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import mars2d
from mars2d import Holonomic, Record, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Car, Differential, Drive
from mars2d.bodies.joints import Rope
from mars2d.bodies.props import Ball
from mars2d.geometry.shapes import Polygon
from mars2d.physics import kernel
from mars2d.physics.kernel import chipmunk
from mars2d.sensors import Bumper, Proximity, RangeFinder, Sensor

KNOWN = kernel.reason_without()
pytestmark = pytest.mark.skipif(bool(KNOWN), reason=f"worlds do without the kernel: {KNOWN}")

Law = Callable[[World], np.ndarray]

ROOM = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
ELL = [(0.0, 0.0), (0.3, 0.0), (0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0.0, 0.3)]


@contextmanager
def plain() -> Iterator[None]:
    """Worlds made in this block take the plain engine."""
    os.environ["MARS2D_PLAIN"] = "1"
    try:
        yield
    finally:
        del os.environ["MARS2D_PLAIN"]


def uses_kernel(world: World) -> bool:
    return world.simulation.engine._kernel is not None


def twins(scenario: Scenario, law: Law, seed: int = 0) -> tuple[World, World]:
    """The same world twice, by the kernel and by the plain engine."""
    quick = World(scenario, law, seed)
    with plain():
        slow = World(scenario, law, seed)
    assert uses_kernel(quick)
    assert not uses_kernel(slow)
    return quick, slow


def assert_same(quick: World, slow: World) -> None:
    """All that a law could see of a world is the same, to the last bit."""
    ours, theirs = (
        {name: getattr(world, name) for name in ("pose", "velocity", "effort")}
        | {name: world.contacts[name] for name in world.contacts.dtype.names}
        for world in (quick, slow)
    )
    for name, array in theirs.items():  # bytes: zero is not minus zero
        assert ours[name].tobytes() == array.tobytes(), f"{name} at {slow.time} s"


def run_both(scenario: Scenario, law: Law, ticks: int, seed: int = 0) -> Record:
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
            "max_acceleration": rng.uniform(1.0, 20.0),
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
    sensors: Sequence[Sensor] = (), **fields: object,
) -> Scenario:  # fmt: skip
    """A room with n robots of all drives, sizes, masses and surfaces, some almost in touch."""
    rng = np.random.default_rng(seed)
    radii = rng.uniform(0.1, 0.3, n)
    half = max(float(np.sqrt(pi * (radii**2).sum() / cover)) / 2, 0.7)
    places = placed(rng, radii.tolist(), half, gap)
    elastic, rough = rng.choice([0.0, 0.5, 1.0], 2)
    drives = [random_drive(rng, faults=faults) for _ in range(min(n, 5))]
    robots = [
        Robot(
            pose=(*place, rng.uniform(-3, 3)), diameter=2 * r, mass=float(rng.uniform(0.7, 3.0)),
            drive=drives[i % len(drives)], friction=rough, restitution=elastic, sensors=sensors,
        )
        for i, (place, r) in enumerate(zip(places.tolist(), radii.tolist(), strict=True))
    ]  # fmt: skip
    room = half + 0.6
    return Scenario(
        robots=robots,
        workspace=[(-room, -room), (room + 1.8, -room), (room + 1.8, room + 0.2), (-room, room)],
        addons=[Map(obstacles(rng, half), friction=0.7, restitution=0.9)],
        stop_time=1e6 * fields.get("sampling_time", 0.1),
        **{"on_exit": "wall", **fields},
    )


def restless(seed: int, n: int) -> Law:
    """Commands that change now and then: ahead, back, turning."""
    draws = np.random.default_rng(seed).uniform(-1, 1, (40, 2, n)) * [[2.0], [3.0]]
    return lambda world: draws[world.iteration // 3 % len(draws)]


@given(
    seed=st.integers(0, 2**32),
    n=st.integers(1, 40),
    max_overlap=st.sampled_from([1e-3, 5e-3, 0.02]),
    sampling_time=st.sampled_from([0.01, 0.05, 0.1, 0.37, 1.0]),
    delay=st.sampled_from([0.0, 0.03, 0.1, 0.237]),
    faults=st.booleans(),
    gap=st.sampled_from([0.0, 1e-6, 0.02]),
    on_exit=st.sampled_from(["wall", "stop", "ignore"]),
)
@example(0, 1, 1e-3, 0.1, 0.0, False, 0.02, "wall")
@example(5, 6, 1e-4, 0.1, 0.0, True, 0.0, "wall")
@example(1, 32, 0.02, 0.1, 0.03, True, 0.0, "wall")
@example(2, 33, 0.02, 0.1, 0.03, True, 0.0, "wall")
@example(3, 100, 1e-3, 0.05, 0.0, False, 0.02, "wall")
@example(4, 100, 0.02, 0.1, 0.07, True, 0.0, "ignore")
@settings(max_examples=20)
def test_a_crowd_moves_the_same_with_and_without(
    seed, n, max_overlap, sampling_time, delay, faults, gap, on_exit
):
    scenario = crowd(
        seed, n, gap=gap, faults=faults, max_overlap=max_overlap, sampling_time=sampling_time,
        command_delay=delay, on_exit=on_exit,
    )  # fmt: skip
    run_both(scenario, restless(seed, n), 3 if sampling_time > 0.3 else 8, seed)


@pytest.mark.parametrize("n", [5, 60])
@pytest.mark.parametrize("max_overlap", [1e-3, 0.02])
def test_so_does_a_crowd_that_is_jammed(n, max_overlap):
    """All drive to the middle, where they push each other until the end."""

    def inwards(world: World) -> np.ndarray:
        return -np.sign(world.pose[:2]) * 2.0

    team = [
        robot.replace(drive=Holonomic(max_linear_speed=1.0), friction=0.5)
        for robot in crowd(n, n).robots
    ]
    room = max(abs(c) for robot in team for c in robot.pose[:2]) + 0.5
    scenario = Scenario(
        robots=team,
        workspace=[(-room, -room), (room, -room), (room, room), (-room, room)],
        on_exit="wall",
        max_overlap=max_overlap,
    )
    record = run_both(scenario, inwards, 50)
    assert len(record.contacts) > 5 * n
    assert record.effort.max() == 1.0


@pytest.mark.parametrize("n", [3, 50])
def test_sensors_find_bodies_where_they_are(n):
    """Rays and points are asked between the steps, when the kernel has put bodies somewhere."""
    sensors = [RangeFinder(beams=16, range=2.0), Proximity(range=0.2), Bumper()]
    scenario = crowd(n, n, gap=0.0, sensors=sensors, max_overlap=0.02)
    record = run_both(scenario, restless(n, n), 25)
    assert len(record.contacts) > n


def test_robots_far_apart_and_alone():
    """A few are kilometres and a thousand kilometres away; what lies between is not kept."""
    near = [Robot(pose=(0.5 * (i % 7), 0.5 * (i // 7), i)) for i in range(40)]
    far = [Robot(pose=(x, 0.3, 0)) for x in (-1e6, -1e3, -1e3 + 0.31, 1e3, 1e6)]
    scenario = Scenario(robots=[*near, *far], workspace=None, sampling_time=0.5, stop_time=1e3)
    record = run_both(scenario, restless(3, 45), 20)
    assert {40 + 1, 40 + 2} <= {*record.contacts["a"].tolist(), *record.contacts["b"].tolist()}


def test_robots_among_long_and_slanted_walls():
    """Walls reach over many of the cells by which the kernel finds who is near them."""
    robots = [Robot(pose=(1.1 * (i % 8), 1.1 * (i // 8) + 0.5, i)) for i in range(64)]
    walls = [
        [(-0.5, -0.55), (9.0, 8.95)],
        [(-0.6, -3.0), (-0.6, 20.0)],
        [(-50.0, 8.5), (50.0, 8.6)],
    ]
    scenario = Scenario(robots=robots, workspace=None, addons=[Map(walls)], sampling_time=0.2)
    record = run_both(scenario, restless(8, 64), 60)
    assert {-1, -2, -3} <= set(record.contacts["b"].tolist())


def test_what_touched_before_is_told_from_what_begins_to():
    """With a delay a control step is driven in two parts, and nothing need touch in the first."""
    bouncing = Robot(restitution=1.0, drive=Unicycle(max_force=50.0))
    again = 0
    for ahead in np.linspace(0.099, 0.1, 21).tolist():  # it hits the wall as the 2nd step begins
        wall = Map([[(ahead + 0.15, -1), (ahead + 0.15, 1)]])
        scenario = Scenario(robots=[bouncing], addons=[wall], command_delay=1e-3)
        record = run_both(scenario, lambda _: np.array([[0.5], [0.0]]), 4)
        again += bool((~record.contacts["began"] & (record.contacts["speed"] == 0)).any())
    assert again > 0


def test_two_worlds_side_by_side_do_not_disturb_each_other():
    first, second = crowd(1, 40), crowd(2, 7)
    alone = [run_both(s, restless(5, len(s.robots)), 15).digest for s in (first, second)]
    worlds = [World(s, restless(5, len(s.robots))) for s in (first, second)]
    for _ in range(15):
        for world in worlds:
            world.step()
    assert [world.record.digest for world in worlds] == alone


# -- which worlds use it --------------------------------------------------------------------


def test_a_team_of_discs_uses_the_kernel_whatever_drives_it():
    for drive in (Unicycle(), Differential(), Holonomic(), Car()):
        assert uses_kernel(World(Scenario(robots=[Robot(drive=drive)])))


@pytest.mark.parametrize(
    "scenario",
    [
        Scenario(robots=2, props=[Ball(pose=(2, 2, 0))]),
        Scenario(robots=2, joints=[Rope(a="robot0", b="robot1")]),
        Scenario(robots=[Robot(shape=Polygon([(-0.1, -0.1), (0.1, -0.1), (0, 0.1)]))]),
        Scenario(robots=[Robot(center_offset=0.1)]),
    ],
    ids=["props", "joints", "polygons", "discs off their centres"],
)
def test_other_worlds_take_the_plain_engine(scenario):
    assert not uses_kernel(World(scenario))


def test_mars2d_plain_switches_it_off():
    with plain():
        assert "MARS2D_PLAIN" in kernel.reason_without()
        assert not uses_kernel(World(Scenario(robots=2)))
    assert kernel.reason_without() == ""


# The quick ones of those whose teams are discs.
EXAMPLES = ["random_walk", "go_to_point", "follow_the_leader", "head_on", "shove_and_spin", "sumo"]


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_is_the_same_with_and_without(name):
    quick = mars2d.run(name)
    with plain():
        slow = mars2d.run(name)
    assert quick.digest == slow.digest
    assert np.array_equal(quick.effort, slow.effort)
    assert np.array_equal(quick.contacts, slow.contacts)


# -- what it relies on ----------------------------------------------------------------------


def test_sines_that_differ_in_one_bit_are_noticed():
    angle = kernel.SAMPLE
    ours = np.sin(angle), np.cos(angle), np.hypot(angle, np.sin(angle))
    assert kernel.as_numpy(*ours)
    for k in range(3):
        changed = [array.copy() for array in ours]
        changed[k][500] = np.nextafter(changed[k][500], np.inf)
        assert not kernel.as_numpy(*changed)


ARBITER = """
typedef struct { double x, y; } cpVect;
enum cpArbiterState { FIRST, SECOND };
struct cpContact { float jnAcc; double other; };
struct cpArbiter { int count; enum cpArbiterState state; };
int cpSpaceStep(void *space, double h);
"""


def test_an_engine_of_another_shape_is_noticed():
    """As pymunk might be some day: functions gone, or of other types; fields likewise."""
    from mars2d.physics.kernel import _kernel

    other = cffi.FFI()
    other.cdef(ARBITER)
    found = list(chipmunk.changes(_kernel.ffi, other, other.dlopen(None)))
    for text in (
        "it has no function cpSpaceStep", "it has no function cpArbiterGetPointB",
        "its struct cpArbiter has no field contacts", "its struct cpContact has no field jtAcc",
        "the field jnAcc of its struct cpContact is a float",
    ):  # fmt: skip
        assert text in found
    other = cffi.FFI()  # without any of the structs
    found = list(chipmunk.changes(_kernel.ffi, other, other.dlopen(None)))
    assert "its struct cpArbiter has no field count" in found


def test_a_function_of_another_type_is_noticed():
    """Only what is pointed to may differ: the kernel knows no body from another thing."""
    ffi = cffi.FFI()
    ffi.cdef("typedef struct { double x, y; } V; typedef struct { float x, y; } F; struct body;")
    ours = ffi.typeof("V(*)(void *, double)")
    assert chipmunk.alike(ours, ffi.typeof("V(*)(struct body *, double)"))
    for other in ("F(*)(void *, double)", "V(*)(void *, float)", "V(*)(void *)", "void *"):
        assert not chipmunk.alike(ours, ffi.typeof(other))


def test_an_array_of_the_wrong_size_is_refused():
    """The kernel would read and write beyond its end."""
    with pytest.raises(TypeError, match="radius"):
        kernel.Kernel({"radius": np.zeros(3, dtype=np.float32)}, {"n": 3})


def test_a_motion_that_can_not_go_on_is_an_error():
    """No gate lets such twists pass; if one did, time would stand still without an end."""
    scenario = Scenario(robots=[Robot(), Robot(pose=(0.31, 0, 0))], workspace=None)
    engine = World(scenario).simulation.engine
    twist = np.array([[1e200, 0.0], [0.0, 0.0], [0.0, 0.0]])
    for _ in range(2):  # it does not go on either
        with pytest.raises(FloatingPointError, match="not finite"):
            engine.drive(twist, 0.1, 0.0)


LOST = """
import numpy as np
from mars2d import Robot, Scenario, World
from mars2d.addons import Map

robots = [Robot(pose=(0.4 * (i % 7), 0.4 * (i // 7), i)) for i in range({n})]
world = World(Scenario(robots=robots, addons=[Map([[(-1, -1), (3, -1.2)]])], on_exit="wall"))
for speed in (1e200, 1e300, np.inf, np.nan):
    twist = np.zeros((3, {n}))
    twist[:, ::3] = speed
    for _ in range(3):
        try:
            world.simulation.engine.drive(twist, 0.1, 0.0)
        except FloatingPointError:
            pass
print("over")
"""


@pytest.mark.parametrize("n", [5, 40])
def test_numbers_out_of_all_bounds_neither_hang_nor_crash_it(child, n):
    done = child(LOST.format(n=n))
    assert done.stdout == "over\n", done.stderr


LONG = """
import os, signal, threading, time
from mars2d import Robot, Scenario, World
from mars2d.addons import Map

walls = Map([[(0.2, -1), (0.2, 1)]])
scenario = Scenario(robots=[Robot()], addons=[walls], sampling_time=1e4, stop_time=1e6)
world = World(scenario, lambda world: [[0.1], [0.0]])
threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    world.step()
except KeyboardInterrupt:
    print(world.over_message)
"""


ALARM = """
def late(*_):
    raise TimeoutError("too late")

signal.signal(signal.SIGINT, late)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are sent otherwise")
def test_ctrl_c_ends_a_control_step_of_ten_million_substeps(child):
    done = child(LONG, timeout=20)
    assert done.stdout == "Interrupted by Ctrl-C\n"
    assert done.stderr == ""


@pytest.mark.skipif(os.name == "nt", reason="signals are sent otherwise")
def test_so_does_what_the_handler_of_another_signal_raises(child):
    code = LONG.replace("walls =", ALARM + "walls =").replace("KeyboardInterrupt", "TimeoutError")
    done = child(code, timeout=20)
    assert done.stdout == "Error: TimeoutError: too late\n"
    assert done.stderr == ""
