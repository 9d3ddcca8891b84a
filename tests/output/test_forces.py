"""Forces are drawn where they act, as long as they are strong, and who slips is marked."""

from __future__ import annotations

import numpy as np
import pytest

from mars2d import Robot, Scenario, Unicycle, World
from mars2d.bodies.props import Box
from mars2d.core.scene import Arrow, Circle, Line, Text
from mars2d.output.layers.arrows import round_force
from mars2d.output.layers.forces import (
    MAX_CONTACTS,
    MAX_LABELS,
    force_scale,
    forces,
    in_newtons,
)
from mars2d.record.contact import CONTACT
from mars2d.record.frame import Frame
from tests.cases import each_case


def of(kind, scene):
    return [shape for shape in scene.shapes if isinstance(shape, kind)]


def vectors(scene):
    """Return the arrows as (k, 2, 2): tails, and what they point along."""
    arrows = of(Arrow, scene)
    return np.array([[a.tail, np.subtract(a.tip, a.tail)] for a in arrows]).reshape(-1, 2, 2)


def two(**changes):
    robots = [Robot(pose=(0, 0, 0)), Robot(pose=(2, 0, 0))]
    return Scenario(robots=robots, **({"sampling_time": 0.1} | changes))


def touching(scenario, rows, effort=(0.0, 0.0)):
    """Return a frame with contacts: a, b, point, normal, impulses along and across the normal."""
    contacts = np.zeros(len(rows), dtype=CONTACT)
    for row, (a, b, point, normal, along, across) in zip(contacts, rows, strict=True):
        row["a"], row["b"], row["point"], row["normal"] = a, b, point, normal
        row["normal_impulse"], row["tangential_impulse"] = along, across
    pose = scenario.initial_pose
    return Frame(scenario, 0.0, 0, pose, pose[None][:0], contacts=contacts, effort=np.array(effort))


def test_a_pair_has_two_opposite_arrows_from_the_point_of_contact_in_newtons():
    scenario = two()
    frame = touching(scenario, [(0, 1, (1.0, 0.0), (1.0, 0.0), 0.4, 0.3)])
    (tail, on_b), (other, on_a) = vectors(forces(frame))
    np.testing.assert_allclose([tail, other], [(1, 0), (1, 0)])
    np.testing.assert_allclose(on_a, -on_b)
    # 0.4 N s along x and 0.3 N s along y in 0.1 s are 4 N and 3 N.
    np.testing.assert_allclose(on_b / force_scale(scenario).unit, (4.0, 3.0))
    assert [text.text for text in of(Text, forces(frame))] == ["5.0 N"]


def test_an_obstacle_has_no_arrow_and_pushes_the_robot_away():
    frame = touching(two(), [(0, -1, (0.15, 0.0), (1.0, 0.0), 0.5, 0.0)])
    ((tail, force),) = vectors(forces(frame))
    np.testing.assert_allclose(tail, (0.15, 0.0))
    assert force[0] < 0


def test_the_bound_of_the_strongest_drive_is_a_robot_and_a_half_long():
    robots = [Robot(pose=(0, 0, 0)), Robot(pose=(2, 0, 0), drive=Unicycle(max_force=8))]
    scale = force_scale(Scenario(robots=robots, workspace=[(-3, -3), (3, -3), (3, 3), (-3, 3)]))
    assert scale.unit * 8 == pytest.approx(1.5 * 0.3)
    assert scale.most == 8


def test_an_impact_is_cut_short_and_says_how_hard_it_was():
    scenario = two()
    scene = forces(touching(scenario, [(0, 1, (1.0, 0.0), (1.0, 0.0), 50.0, 0.0)]))
    lengths = np.hypot(*vectors(scene)[:, 1].T)
    np.testing.assert_allclose(lengths, force_scale(scenario).longest)
    assert len(of(Line, scene)) == 4  # two strokes across each arrow
    assert [text.text for text in of(Text, scene)] == ["500 N"]
    usual = forces(touching(scenario, [(0, 1, (1.0, 0.0), (1.0, 0.0), 0.5, 0.0)]))
    assert not of(Line, usual)


def test_of_many_contacts_the_strongest_are_drawn_and_few_have_numbers():
    rows = [(0, 1, (0.01 * k, 0.0), (0.0, 1.0), 0.1 + 0.01 * k, 0.0) for k in range(100)]
    scene = forces(touching(two(), rows))
    found = vectors(scene)
    assert len(found) == 2 * MAX_CONTACTS
    assert found[:, 0, 0].min() == pytest.approx(0.01 * (100 - MAX_CONTACTS))
    assert len(of(Text, scene)) == MAX_LABELS


def test_a_drive_at_its_bound_has_a_ring_round_its_robot():
    rings = of(Circle, forces(touching(two(), [], effort=(0.998, 1.0))))
    assert {ring.center for ring in rings} == {(2.0, 0.0)}
    assert {ring.radius for ring in rings} == {0.15}


def test_a_pushed_box_is_held_by_what_the_robot_can_push_with():
    box = Box(pose=(0.5, 0, 0), length=0.3, width=0.3, ground_friction=0.6, mass=1)
    robot = Robot(drive=Unicycle(max_force=5))
    world = World(Scenario(robots=[robot], props=[box], workspace=None, stop_time=5))
    while world.time < 4:
        world.step([[0.2], [0.0]])
    frame = world.frame
    (tail, on_box), (_, on_robot) = vectors(forces(frame))
    size = force_scale(world.scenario).unit
    np.testing.assert_allclose(on_box / size, (5.0, 0.0), atol=0.01)
    np.testing.assert_allclose(on_robot, -on_box)
    np.testing.assert_allclose(tail, frame.pose[:2, 0] + (0.15, 0.0), atol=1e-3)
    assert len(of(Circle, forces(frame))) == 2  # its drive slips


@each_case(
    "force, text",
    [(0.123, "0.12 N"), (0.997, "1.0 N"), (9.96, "10 N"), (999.7, "1 kN"), (2400, "2.4 kN")],
)
def test_forces_are_read_with_two_digits(force, text):
    assert in_newtons(force) == text


@each_case("most, round_", [(1, 1), (1.99, 1), (2, 2), (9.9, 5), (10, 10), (0.3, 0.2), (730, 500)])
def test_the_legend_has_a_round_force(most, round_):
    assert round_force(most) == pytest.approx(round_)
