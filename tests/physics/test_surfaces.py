"""Friction and restitution by other rules, by pairs of materials, and at rest: closed forms."""

from __future__ import annotations

from math import atan, cos, hypot, pi, radians, sin, sqrt, tan

import numpy as np
import pytest

from mars2d import Holonomic, MaterialPair, Record, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Ball, Box, Rope, Spring
from mars2d.core.materials import GRAVITY, MATERIALS, RULES
from mars2d.physics import translation
from mars2d.scenario.experiment import open_experiment
from mars2d.world.loop import simulate
from tests.cases import each_case
from tests.islands import plainly

BY_RULE = {
    "product": lambda p, q: p * q,
    "minimum": min,
    "mean": lambda p, q: 0.5 * p + 0.5 * q,
    "geometric": lambda p, q: sqrt(p) * sqrt(q),
    "maximum": max,
}
assert tuple(BY_RULE) == RULES


def run(scenario: Scenario, command: object, seconds: float) -> Record:
    """Run a scenario; command: an array, or a function of the time."""
    world = World(scenario.replace(stop_time=seconds))
    while not world.over:
        world.step(command(world.time) if callable(command) else command)
    return world.record


def speed_along(record: Record, axis: int = 0) -> float:
    """The mean velocity of the first robot in the last half of a run."""
    half = len(record) // 2
    return (record.pose[-1, axis, 0] - record.pose[half, axis, 0]) / (
        record.time[-1] - record.time[half]
    )


# -- a robot along a wall ---------------------------------------------------------------------


def at_wall(angle: float, robot: dict, wall: dict, *, apart: float = 0.0, **fields) -> Record:
    """Drive against a wall at an angle to it, from rest at it or from some way off."""
    slider = Robot(
        pose=(0, 0.2 + apart, -angle), diameter=0.4, mass=1.7,
        drive=Unicycle(max_force=6.5, max_torque=1000), **robot,
    )  # fmt: skip
    chart = Map([[(-3, 0), (9, 0)]], **wall)
    scenario = Scenario(robots=[slider], addons=[chart], workspace=None, **fields)
    return run(scenario, [[0.23], [0.0]], 5.0)


@each_case("rule", RULES)
@each_case("share", [0.5, 0.97, 1.03])
def test_a_robot_slides_along_a_wall_up_to_the_friction_of_each_rule(rule, share):
    mu = BY_RULE[rule](0.35, 0.87)
    angle = atan(share / mu)  # it sticks from tan(angle) = 1 / mu on
    record = at_wall(angle, {"friction": 0.35}, {"friction": 0.87}, friction_rule=rule)
    contact = record.contacts[-1]
    ratio = abs(contact["tangential_impulse"]) / contact["normal_impulse"]
    assert ratio == pytest.approx(min(mu, 1 / tan(angle)), rel=2e-3)
    slides = 0.23 * max(cos(angle) - mu * sin(angle), 0.0)
    assert speed_along(record) == pytest.approx(slides, abs=1e-3 * 0.23)


@each_case("rule", RULES)
def test_a_pair_has_its_own_friction_whatever_the_rule(rule):
    pairs = [MaterialPair("rubber", "ice", friction=0.11)]
    record = at_wall(
        0.8, {"friction": "rubber"}, {"friction": "ice"}, friction_rule=rule, material_pairs=pairs
    )
    contact = record.contacts[-1]
    assert abs(contact["tangential_impulse"]) == pytest.approx(0.11 * contact["normal_impulse"])
    assert speed_along(record) == pytest.approx(0.23 * (cos(0.8) - 0.11 * sin(0.8)), abs=3e-4)


@each_case(
    ("robot", "wall"), [("rubber", "steel"), ("rubber", 0.22), (1.07, "ice"), ("wood", "ice")]
)
def test_other_materials_and_numbers_go_by_the_rule(robot, wall):
    pairs = [MaterialPair("rubber", "ice", friction=0.001)]
    values = [MATERIALS[f].friction if isinstance(f, str) else f for f in (robot, wall)]
    record = at_wall(0.6, {"friction": robot}, {"friction": wall}, material_pairs=pairs)
    contact = record.contacts[-1]
    ratio = abs(contact["tangential_impulse"]) / contact["normal_impulse"]
    assert ratio == pytest.approx(values[0] * values[1], rel=1e-6)


@each_case("by_pair", [False, True])
def test_static_friction_holds_what_rests_and_not_what_slides(by_pair):
    """Between both coefficients it depends on how a robot came there."""
    static, kinetic = 0.9, 0.5
    if by_pair:
        pair = MaterialPair("wood", "felt", friction=kinetic, static_friction=static)
        surfaces = {"friction": "wood"}, {"friction": "felt"}, {"material_pairs": [pair]}
    else:
        surfaces = {"friction": kinetic, "static_friction": static}, {}, {}
    robot, wall, fields = surfaces
    angle = atan(1 / 0.7)
    rests = at_wall(angle, robot, wall, **fields)
    comes = at_wall(angle, robot, wall, apart=0.1, **fields)
    assert speed_along(rests) == pytest.approx(0.0, abs=1e-6)
    assert speed_along(comes) == pytest.approx(0.23 * (cos(angle) - 0.5 * sin(angle)), rel=5e-3)
    for record, ratio in ((rests, 1 / tan(angle)), (comes, kinetic)):
        contact = record.contacts[-1]
        found = abs(contact["tangential_impulse"]) / contact["normal_impulse"]
        assert found == pytest.approx(ratio, rel=2e-3)


def test_a_robot_that_turns_its_push_begins_to_slide_at_static_and_stops_at_kinetic_friction():
    """The push turns from the normal to 60 degrees beside it and back, by a degree a second."""
    static, kinetic = 0.8, 0.45
    robot = Robot(
        pose=(0, 0.2, 0), diameter=0.4, drive=Holonomic(max_force=3.0, max_torque=1000),
        friction=kinetic, static_friction=static,
    )  # fmt: skip
    scenario = Scenario(robots=[robot], addons=[Map([[(-9, 0), (99, 0)]])], workspace=None)

    def lean(time: float) -> float:
        return radians(60 - abs(60 - time))

    def push(time: float) -> np.ndarray:
        return np.array([[0.4 * sin(lean(time))], [-0.4 * cos(lean(time))]])

    record = run(scenario, push, 120)
    speed = np.diff(record.pose[:, 0, 0]) / 0.1
    times = record.time[1:]
    slides = times[speed > 2e-3]
    assert lean(slides[0]) == pytest.approx(atan(static), abs=radians(0.6))
    assert lean(slides[-1]) == pytest.approx(atan(kinetic), abs=radians(0.6))
    rows = record.contacts
    mean = np.abs(rows["tangential_impulse"]) / rows["normal_impulse"]
    within = (rows["time"] > slides[0] + 1) & (rows["time"] < slides[-1] - 1)
    assert np.abs(mean[within] - kinetic).max() < 2e-3
    # It slides at the speed at which the wheels' slip leans by the angle of friction.
    k = int(np.searchsorted(times, 60.0))
    assert speed[k] == pytest.approx(0.4 * (sin(lean(60)) - kinetic * cos(lean(60))), rel=5e-3)


# -- impacts ----------------------------------------------------------------------------------


def impact(friction: object, restitution: object, **fields) -> tuple[np.ndarray, float, float]:
    """Let a disc graze one at rest; return (normal, tangential impulse), and what was expected.

    Returns impulses, the closing speed along the normal times the reduced mass, and the impulse
    that would end all sliding.
    """
    m, n, r, s, v = 0.7, 1.9, 0.12, 0.17, 2.3
    beside = 0.4 * (r + s)
    first = Ball(
        diameter=2 * r, mass=m, velocity=(v, 0, 4.0), pose=(-1, beside, 0),
        friction=friction[0], restitution=restitution[0],
    )  # fmt: skip
    second = Ball(
        diameter=2 * s, mass=n, friction=friction[1], restitution=restitution[1]
    )  # fmt: skip
    scenario = Scenario(
        robots=[Robot(pose=(0, 5, 0))], props=[first, second], workspace=None, sampling_time=0.01,
        **fields,
    )  # fmt: skip
    record = run(scenario, [[0.0], [0.0]], 1.0)
    [row] = record.contacts[record.contacts["began"]]
    along, across = v * sqrt(1 - 0.16), abs(0.4 * v + 4.0 * r)
    reduced = 1 / (1 / m + 1 / n)
    ends = across / (1 / m + 1 / n + r * r / (m * r * r / 2) + s * s / (n * s * s / 2))
    push = m * np.diff(record.prop_pose[:, :2, 0], axis=0) / 0.01
    assert np.allclose(np.hypot(*(push[-1] - push[0])), row["impulse"], rtol=0.02)
    found = np.array([row["normal_impulse"], abs(row["tangential_impulse"])])
    return found, reduced * along, ends


@each_case("friction_rule", RULES)
@each_case("restitution_rule", RULES)
def test_a_grazing_blow_has_the_impulses_of_both_rules(friction_rule, restitution_rule):
    rules = {"friction_rule": friction_rule, "restitution_rule": restitution_rule}
    found, blow, ends = impact((0.04, 0.11), (0.35, 0.8), **rules)
    e, mu = BY_RULE[restitution_rule](0.35, 0.8), BY_RULE[friction_rule](0.04, 0.11)
    normal = (1 + e) * blow
    assert mu * normal < ends  # it slides until the end
    assert found == pytest.approx([normal, mu * normal], rel=1e-2)


@each_case("names", [("glass", "steel"), ("steel", "glass")])
def test_a_grazing_blow_of_a_pair_has_its_values_in_either_order(names):
    pairs = [
        MaterialPair("ice", "steel", friction=0.5, restitution=0.1),
        MaterialPair("glass", "steel", friction=0.02, restitution=0.91),
        MaterialPair("glass", "glass", friction=0.3),
    ]
    found, blow, _ = impact(names, names, material_pairs=pairs)
    assert found == pytest.approx([1.91 * blow, 0.02 * 1.91 * blow], rel=1e-2)


def test_what_a_pair_leaves_out_and_what_is_a_number_goes_by_the_rule():
    pairs = [MaterialPair("glass", "steel", restitution=0.3)]
    table = MATERIALS["glass"], MATERIALS["steel"]
    found, blow, ends = impact(("glass", "steel"), ("glass", "steel"), material_pairs=pairs)
    mu = table[0].friction * table[1].friction
    normal = 1.3 * blow
    assert found == pytest.approx([normal, min(mu * normal, ends)], rel=1e-2)
    found, blow, _ = impact((0.05, 0.4), ("glass", 0.5), material_pairs=pairs)
    normal = (1 + 0.5 * table[0].restitution) * blow
    assert found == pytest.approx([normal, 0.02 * normal], rel=1e-2)


# -- the floor --------------------------------------------------------------------------------


@each_case("kinetic", [0.0, 0.25])
@each_case("share", [0.98, 1.02])
def test_a_box_breaks_loose_at_static_friction_and_then_slides_at_kinetic(share, kinetic):
    mass, static, pulls = 1.3, 0.6, 0.9
    force = share * static * mass * GRAVITY
    box = Box(pose=(0, 0, 0), mass=mass, ground_friction=kinetic, static_ground_friction=static)
    robot = Robot(
        pose=(1, 0, 0), mass=pulls, drive=Unicycle(max_force=force, max_linear_speed=90)
    )  # fmt: skip
    scenario = Scenario(
        robots=[robot], props=[box], joints=[Rope(a="robot0", b="box0")], workspace=None
    )
    x = run(scenario, [[90.0], [0.0]], 3.0).prop_pose[:, 0, 0]
    if share < 1:
        assert np.ptp(x) < 1e-3
    else:
        wanted = (force - kinetic * mass * GRAVITY) / (mass + pulls)
        assert (x[-1] - 2 * x[-11] + x[-21]) / 1.0 == pytest.approx(wanted, rel=0.02)


def test_a_box_that_glides_knows_kinetic_friction_alone():
    plain = Box(velocity=(1.7, 0.3, 2.0), ground_friction=0.31)
    held = plain.replace(static_ground_friction=0.8)
    ways = [
        run(Scenario(robots=[Robot(pose=(0, 3, 0))], props=[box]), [[0.0], [0.0]], 3).digest
        for box in (plain, held)
    ]
    assert ways[0] == ways[1]


def test_a_hand_pulls_a_box_loose_at_static_friction():
    box = Box(mass=2.0, ground_friction=0.2, static_ground_friction=0.5)
    world = World(Scenario(robots=[Robot(pose=(0, 3, 0))], props=[box], stop_time=9))
    most = 0.5 * 2.0 * GRAVITY
    assert world.simulation.engine.withstands(1, 0.99 * most, 0.0)
    assert not world.simulation.engine.withstands(1, 1.01 * most, 0.0)


def stick_slip(k: float, m: float, static: float, kinetic: float, v: float) -> Record:
    """Draw a box by a spring, whose other end moves at v m/s."""
    box = Box(mass=m, ground_friction=kinetic, static_ground_friction=static)
    robot = Robot(pose=(1, 0, 0), drive=Unicycle(max_force=90.0))
    spring = Spring(a="robot0", b="box0", stiffness=k)
    scenario = Scenario(
        robots=[robot], props=[box], joints=[spring], workspace=None, sampling_time=0.01
    )
    return run(scenario, [[v], [0.0]], 15.0)


@each_case(
    ("k", "m", "static", "kinetic", "v"),
    [(30.0, 1.5, 0.5, 0.3, 0.1), (80.0, 0.7, 0.9, 0.2, 0.05), (55.0, 2.2, 0.33, 0.3, 0.17)],
)
def test_a_box_at_a_spring_moves_in_jerks_with_the_period_of_the_formula(k, m, static, kinetic, v):
    """Stick: 2 d / v. Slip: the half of a swing and more, until the box is at rest again."""
    record = stick_slip(k, m, static, kinetic, v)
    speed = np.diff(record.prop_pose[:, 0, 0]) / 0.01
    middle = record.time[1:] - 0.005
    up = np.flatnonzero((speed[:-1] < v) & (speed[1:] >= v))
    starts = middle[up] + 0.01 * (v - speed[up]) / (speed[up + 1] - speed[up])
    w, d = sqrt(k / m), (static - kinetic) * m * GRAVITY / k
    period = 2 * d / v + 2 / w * (pi - atan(d * w / v))
    assert len(starts) >= 4
    assert np.diff(starts) == pytest.approx(period, rel=0.015)
    assert speed.max() == pytest.approx(v + hypot(v, w * d), rel=0.015)


# -- what is asked for, and what is not -------------------------------------------------------


def mover(scenario: Scenario) -> object:
    with plainly():
        return translation.mover_of(scenario)


@each_case("name", ["crowd", "wall_slide", "billiards"])
def test_who_asks_for_nothing_pays_for_nothing(name):
    assert mover(open_experiment(name).scenario).surfaces is None


@each_case("name", ["shove_and_spin", "wall_slide", "billiards", "crowd"])
def test_static_friction_as_large_as_the_kinetic_one_changes_no_bit(name):
    """The solver asks for each contact then, and gets what it would have worked out itself."""
    experiment = open_experiment(name, {"stop_time": 3.0})
    usual = experiment.scenario
    first = usual.robots[0].replace(static_friction=usual.robots[0].friction)
    asked = usual.replace(robots=[first, *usual.robots[1:]])
    assert mover(asked).surfaces is not None
    digests = [simulate(experiment.redrawn(scenario)).record.digest for scenario in (usual, asked)]
    assert digests[0] == digests[1]


def test_walls_in_one_line_keep_their_own_surfaces():
    """They have the same values, so for the product alone they would be joined."""
    pairs = [
        MaterialPair("rubber", "wood", friction=0.3),
        MaterialPair("rubber", "glass", friction=0.6),
    ]
    walls = [
        Map([[(-3, 0), (0, 0)]], name="left", friction="wood"),
        Map([[(0, 0), (9, 0)]], name="right", friction="glass"),
    ]
    drive = Unicycle(max_torque=1000, max_linear_speed=1)
    slider = Robot(pose=(-1, 0.15, -0.6), drive=drive, friction="rubber")
    scenario = Scenario(robots=[slider], addons=walls, workspace=None, material_pairs=pairs)
    record = run(scenario, [[0.5], [0.0]], 8.0)
    rows = record.contacts
    ratio = np.abs(rows["tangential_impulse"]) / rows["normal_impulse"]
    left, right = rows["point"][:, 0] < -0.2, rows["point"][:, 0] > 0.2
    assert min(left.sum(), right.sum()) > 9
    assert ratio[left][2:] == pytest.approx(0.3, rel=1e-6)
    assert ratio[right] == pytest.approx(0.6, rel=1e-6)


def test_a_wall_of_several_obstacles_has_their_surface():
    """Such a wall is joined, and has a number of its own."""
    walls = [
        Map([[(-3, 0), (0, 0)], [(0, 0), (1.5, 0)]], name="left", friction=0.25),
        Map([[(1.5, 0), (9, 0)]], name="right", friction=0.25),
    ]
    slider = Robot(pose=(-1, 0.15, -0.6), drive=Unicycle(max_torque=1000), friction=0.9)
    scenario = Scenario(robots=[slider], addons=walls, workspace=None, friction_rule="minimum")
    rows = run(scenario, [[0.5], [0.0]], 8.0).contacts
    assert set(rows["b"].tolist()) == {-1, -2, -3}
    rows = rows[rows["normal_impulse"] > 0]
    ratio = np.abs(rows["tangential_impulse"]) / rows["normal_impulse"]
    assert ratio[2:] == pytest.approx(0.25, rel=1e-6)
