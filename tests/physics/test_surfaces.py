"""Friction and restitution by other rules, by pairs of materials, and at rest: closed forms."""

from __future__ import annotations

from math import atan, cos, hypot, pi, sin, sqrt, tan

import numpy as np
import pytest

from mars2d import MaterialPair, Record, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies import Ball, Box, Rope, Spring
from mars2d.core.materials import GRAVITY, MATERIALS, RULES
from mars2d.scenario.experiment import open_experiment
from mars2d.world.loop import simulate
from tests.cases import each_case
from tests.islands import mover_of
from tests.worlds import endless

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


PRODUCTS = [("rubber", "steel"), ("rubber", 0.22), (1.07, "ice"), ("wood", "ice")]


@each_case(
    ("robot", "wall", "rule"),
    [*(("rubber", "ice", rule) for rule in RULES), *((*pair, "product") for pair in PRODUCTS)],
)
def test_a_pair_has_its_own_friction_and_other_materials_and_numbers_go_by_the_rule(
    robot, wall, rule
):
    pairs = [MaterialPair("rubber", "ice", friction=0.11)]
    mine, other = (MATERIALS[f].friction if isinstance(f, str) else f for f in (robot, wall))
    mu = 0.11 if (robot, wall) == ("rubber", "ice") else mine * other
    record = at_wall(
        0.6, {"friction": robot}, {"friction": wall}, friction_rule=rule, material_pairs=pairs
    )
    contact = record.contacts[-1]
    assert abs(contact["tangential_impulse"]) == pytest.approx(mu * contact["normal_impulse"])
    assert speed_along(record) == pytest.approx(0.23 * (cos(0.6) - mu * sin(0.6)), abs=3e-4)


@each_case("by_pair", [False, True])
@each_case("needed", [0.48, 0.52, 0.7, 0.88, 0.92])
def test_static_friction_holds_what_rests_and_not_what_slides(by_pair, needed):
    """Between both coefficients it depends on how a robot came there.

    needed: the ratio of friction to push that holds it.
    """
    static, kinetic = 0.9, 0.5
    if by_pair:
        pair = MaterialPair("wood", "felt", friction=kinetic, static_friction=static)
        surfaces = {"friction": "wood"}, {"friction": "felt"}, {"material_pairs": [pair]}
    else:
        surfaces = {"friction": kinetic, "static_friction": static}, {}, {}
    robot, wall, fields = surfaces
    angle = atan(1 / needed)
    for apart, most in ((0.0, static), (0.1, kinetic)):
        record = at_wall(angle, robot, wall, apart=apart, **fields)
        contact = record.contacts[-1]
        found = abs(contact["tangential_impulse"]) / contact["normal_impulse"]
        ratio = needed if needed < most else kinetic
        assert found == pytest.approx(ratio, rel=2e-3)
        slides = 0.23 * (cos(angle) - ratio * sin(angle))
        assert speed_along(record) == pytest.approx(slides, rel=5e-3, abs=1e-3 * 0.23)


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


def test_a_grazing_blow_of_a_pair_has_its_values_and_what_it_leaves_out_goes_by_the_rule():
    pairs = [
        MaterialPair("ice", "steel", friction=0.5, restitution=0.1),
        MaterialPair("glass", "steel", friction=0.02, restitution=0.91),
        MaterialPair("glass", "glass", friction=0.3),
    ]
    for names in (("glass", "steel"), ("steel", "glass")):
        found, blow, _ = impact(names, names, material_pairs=pairs)
        assert found == pytest.approx([1.91 * blow, 0.02 * 1.91 * blow], rel=1e-2)
    pairs = [MaterialPair("glass", "steel", restitution=0.3)]
    glass, steel = MATERIALS["glass"], MATERIALS["steel"]
    found, blow, ends = impact(names, names, material_pairs=pairs)
    normal = 1.3 * blow
    assert found == pytest.approx(
        [normal, min(glass.friction * steel.friction * normal, ends)], rel=1e-2
    )
    found, blow, _ = impact((0.05, 0.4), ("glass", 0.5), material_pairs=pairs)
    normal = (1 + 0.5 * glass.restitution) * blow
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
    engine = endless([Robot(pose=(0, 3, 0))], [box]).simulation.engine
    found = [engine.withstands(1, share * 0.5 * 2.0 * GRAVITY, 0.0) for share in (0.99, 1.01)]
    assert found == [True, False]


@each_case(
    ("k", "m", "static", "kinetic", "v"),
    [(30.0, 1.5, 0.5, 0.3, 0.1), (80.0, 0.7, 0.9, 0.2, 0.05), (55.0, 2.2, 0.33, 0.3, 0.17)],
)
def test_a_box_at_a_spring_moves_in_jerks_with_the_period_of_the_formula(k, m, static, kinetic, v):
    """Stick: 2 d / v. Slip: the half of a swing and more, until the box is at rest again."""
    box = Box(mass=m, ground_friction=kinetic, static_ground_friction=static)
    robot = Robot(pose=(1, 0, 0), drive=Unicycle(max_force=90.0))
    scenario = Scenario(
        robots=[robot], props=[box], joints=[Spring(a="robot0", b="box0", stiffness=k)],
        workspace=None, sampling_time=0.01,
    )  # fmt: skip
    record = run(scenario, [[v], [0.0]], 15.0)
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


@each_case("name", ["shove_and_spin", "wall_slide", "billiards", "crowd"])
def test_static_friction_as_large_as_the_kinetic_one_changes_no_bit(name):
    """The solver asks for each contact then, and gets what it would have worked out itself."""
    experiment = open_experiment(name, {"stop_time": 3.0})
    usual = experiment.scenario
    first = usual.robots[0].replace(static_friction=usual.robots[0].friction)
    asked = usual.replace(robots=[first, *usual.robots[1:]])
    assert [mover_of(each).surfaces is None for each in (usual, asked)] == [True, False]
    digests = [simulate(experiment.redrawn(scenario)).record.digest for scenario in (usual, asked)]
    assert digests[0] == digests[1]


def test_walls_in_one_line_keep_their_own_surfaces():
    """They have the same values, so for the product alone they would be joined."""
    pairs = [
        MaterialPair("rubber", "wood", friction=0.3),
        MaterialPair("rubber", "glass", friction=0.6),
    ]
    left, right = (
        Map([[(-3, 0), (0, 0)]], friction="wood"),
        Map([[(0, 0), (9, 0)]], friction="glass"),
    )
    rows = slid([left, right.replace(name="right")], "rubber", material_pairs=pairs)
    ratio = np.abs(rows["tangential_impulse"]) / rows["normal_impulse"]
    left, right = rows["point"][:, 0] < -0.2, rows["point"][:, 0] > 0.2
    assert min(left.sum(), right.sum()) > 9
    assert ratio[left][2:] == pytest.approx(0.3, rel=1e-6)
    assert ratio[right] == pytest.approx(0.6, rel=1e-6)


def slid(walls: list, friction: object, **fields) -> np.ndarray:
    """Slide over walls along the x axis from -1 m on; return what pushed."""
    drive = Unicycle(max_torque=1000, max_linear_speed=1)
    slider = Robot(pose=(-1, 0.15, -0.6), drive=drive, friction=friction)
    scenario = Scenario(robots=[slider], addons=walls, workspace=None, **fields)
    rows = run(scenario, [[0.5], [0.0]], 8.0).contacts
    return rows[rows["normal_impulse"] > 0]


def test_a_wall_of_several_obstacles_has_their_surface():
    """Such a wall is joined, and has a number of its own."""
    walls = [
        Map([[(-3, 0), (0, 0)], [(0, 0), (1.5, 0)]], name="left", friction=0.25),
        Map([[(1.5, 0), (9, 0)]], name="right", friction=0.25),
    ]
    rows = slid(walls, 0.9, friction_rule="minimum")
    assert set(rows["b"].tolist()) == {-1, -2, -3}
    ratio = np.abs(rows["tangential_impulse"]) / rows["normal_impulse"]
    assert ratio[2:] == pytest.approx(0.25, rel=1e-6)
