"""Contacts are reported as rows: who, when, where, which way and how hard."""

from __future__ import annotations

import numpy as np
import pytest

from mars2d import Holonomic, LawError, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies.props import Box, Puck
from mars2d.record.contact import CONTACT
from mars2d.world.verify import rerun
from tests.cases import each_case


def world_of(*robots: Robot, **fields) -> World:
    fields.setdefault("workspace", None)
    return World(Scenario(robots=list(robots), **fields))


def drive(world: World, command, ticks: int) -> np.ndarray:
    for _ in range(ticks):
        world.step(command)
    return world.record.contacts


def wall_at(x: float) -> list[tuple[float, float]]:
    return [(x, -1.0), (x, 1.0)]


def test_two_robots_that_meet_make_one_row_each_control_step():
    world = world_of(Robot(), Robot(pose=(0.51, 0, np.pi)))
    none = drive(world, [[0, 0], [0, 0]], 3)
    assert (none.dtype, len(none), world.record.collisions) == (CONTACT, 0, 0)
    contacts = drive(world, [[0.2, 0.2], [0, 0]], 17)
    assert set(zip(contacts["a"].tolist(), contacts["b"].tolist(), strict=True)) == {(0, 1)}
    # The gap of 0.21 m closes at 0.4 m/s: they meet after 0.525 s.
    assert contacts["time"][0] == pytest.approx(0.3 + 0.525, abs=5e-3)
    assert len(contacts) == pytest.approx(12, abs=1)
    steps = np.floor(contacts["time"] / 0.1 + 1e-9)
    assert len(np.unique(steps)) == len(contacts)


def test_the_normal_points_from_a_to_b_and_the_point_lies_on_the_surface_of_a():
    world = world_of(Robot(pose=(1, 1, 0)), Robot(pose=(1.4, 1.3, 0), drive=Holonomic()))
    command = [[0, -0.2], [0, -0.15]]
    contacts = drive(world, command, 10)
    assert len(contacts) > 0
    row = contacts[0]
    assert row["normal"] == pytest.approx([0.8, 0.6], abs=1e-3)
    assert row["point"] == pytest.approx([1 + 0.15 * 0.8, 1 + 0.15 * 0.6], abs=2e-3)


@each_case("sampling_time", [0.05, 0.1, 1.0])
@each_case("force", [2.0, 5.0])
def test_pressing_against_a_wall_gives_the_impulse_force_times_time(force, sampling_time):
    world = world_of(
        Robot(drive=Unicycle(max_force=force)),
        addons=[Map([wall_at(0.3)])],
        sampling_time=sampling_time,
    )
    contacts = drive(world, [[0.2], [0]], round(4 / sampling_time))
    late = contacts[contacts["time"] > 2]
    assert len(late) > 0
    assert late["impulse"] == pytest.approx(force * sampling_time, rel=0.01)
    assert (late["b"] == -1).all()
    assert late["normal"] == pytest.approx(np.tile([1.0, 0], (len(late), 1)))
    assert late["point"][:, 0] == pytest.approx(0.3, abs=1e-3)


SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
FAR = [Map([wall_at(50), wall_at(60)], name="far"), Map([wall_at(70), wall_at(80)], name="more")]


@each_case(
    ("others", "fields", "pair"),
    [
        ([Robot(pose=(0.4, 0, 0)), Robot(pose=(-9, 0, 0))], {}, (0, 1)),
        ([], {"addons": [*FAR, Map([wall_at(70), wall_at(0.3)], name="near")]}, (0, -6)),
        ([], {"addons": FAR, "workspace": SQUARE, "on_exit": "wall"}, (0, -5)),
        ([Robot(pose=(0, 5, 0))], {"props": [Puck(pose=(3, 3)), Box(pose=(0.5, 0, 0))]}, (0, 3)),
    ],
)
def test_bodies_are_numbered_on_and_obstacles_down_with_the_workspace_as_the_last(
    others, fields, pair
):
    robots = [Robot(), *others]
    for drives in range(2 if len(others) == 2 else 1):  # the lower index is a whoever drives
        world, command = world_of(*robots, **fields), np.zeros((2, len(robots)))
        command[0, drives] = 0.5 - drives
        contacts = drive(world, command, 30)
        assert set(contacts[["a", "b"]].tolist()) == {pair}
        assert contacts["normal"][0] == pytest.approx([1, 0], abs=1e-6)
        assert pair[1] >= 0 or len(world.obstacles) == -pair[1]


def test_the_views_of_a_law_show_its_own_contacts_of_the_last_step():
    seen: list[list[int]] = []

    def law(world):
        seen.append([len(robot.contacts) for robot in world.robots])
        return [[0.2, 0.2, 0.0], [0, 0, 0]]

    robots = [Robot(), Robot(pose=(0.5, 0, np.pi)), Robot(pose=(0, 3, 0))]
    world = World(Scenario(robots=robots, workspace=None), control=law)
    for _ in range(20):
        world.step()
    assert seen[0] == [0, 0, 0]
    assert seen[-1] == [1, 1, 0]


@each_case("gap", [0.0, 1e-15, -1e-15])
def test_robots_that_stand_at_exactly_zero_distance_are_no_trouble(gap):
    world = world_of(Robot(), Robot(pose=(0.3 + gap, 0, 0)), addons=[Map([wall_at(0.45)])])
    drive(world, [[0, 0], [0, 0]], 5)
    assert np.abs(world.pose[0] - [0, 0.3]).max() < 5e-5  # a quarter of the slop each


def test_a_run_that_a_law_breaks_off_in_contact_can_be_run_again():
    """The last control step may have been done, and its contacts noted, but no row written."""

    def law(world):
        if world.iteration == 60:
            raise RuntimeError("no more")
        return [[0.3, 0.3], [0.0, 0.0]]

    scenario = Scenario(
        robots=[Robot(pose=(0, 0, 0)), Robot(pose=(0.6, 0, np.pi))], sampling_time=0.05
    )
    world = World(scenario, law)
    with pytest.raises(LawError) as error:
        while True:
            world.step()
    record = error.value.record
    assert record.contacts["time"][-1] == record.time[-1]
    assert rerun(record) is None
