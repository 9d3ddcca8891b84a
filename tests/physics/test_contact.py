"""Contacts are reported as rows: who, when, where, which way and how hard."""

from __future__ import annotations

import numpy as np
import pytest

from mars2d import Holonomic, LawError, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies.props import Box, Puck
from mars2d.record.contact import CONTACT, episodes
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


def test_without_contact_there_are_no_rows():
    world = world_of(Robot(), Robot(pose=(1, 0, 0)))
    contacts = drive(world, [[0, 0], [0, 0]], 3)
    assert contacts.dtype == CONTACT
    assert len(contacts) == 0
    assert world.record.collisions == 0


def test_two_robots_that_meet_make_one_row_each_control_step():
    world = world_of(Robot(), Robot(pose=(0.51, 0, np.pi)))
    contacts = drive(world, [[0.2, 0.2], [0, 0]], 20)
    assert set(zip(contacts["a"].tolist(), contacts["b"].tolist(), strict=True)) == {(0, 1)}
    # The gap of 0.21 m closes at 0.4 m/s: they meet after 0.525 s.
    assert contacts["time"][0] == pytest.approx(0.525, abs=5e-3)
    assert len(contacts) == pytest.approx(15, abs=1)
    steps = np.floor(contacts["time"] / 0.1 + 1e-9)
    assert len(np.unique(steps)) == len(contacts)


def test_a_contact_has_began_only_in_its_first_step():
    world = world_of(Robot(), Robot(pose=(0.5, 0, np.pi)))
    drive(world, [[0.2, 0.2], [0, 0]], 20)
    drive(world, [[-0.2, -0.2], [0, 0]], 10)
    contacts = drive(world, [[0.2, 0.2], [0, 0]], 30)
    assert contacts["began"].sum() == 2
    assert contacts["began"][0]
    assert world.record.collisions == 2


def test_the_normal_points_from_a_to_b_and_the_point_lies_on_the_surface_of_a():
    world = world_of(Robot(pose=(1, 1, 0)), Robot(pose=(1.4, 1.3, 0), drive=Holonomic()))
    command = [[0, -0.2], [0, -0.15]]
    contacts = drive(world, command, 10)
    assert len(contacts) > 0
    row = contacts[0]
    assert row["normal"] == pytest.approx([0.8, 0.6], abs=1e-3)
    assert row["point"] == pytest.approx([1 + 0.15 * 0.8, 1 + 0.15 * 0.6], abs=2e-3)


def test_the_lower_index_is_a_even_if_the_other_one_drives():
    world = world_of(Robot(pose=(0.5, 0, 0)), Robot(pose=(0, 0, 0)), Robot(pose=(-9, 0, 0)))
    contacts = drive(world, [[0, 0.3, 0], [0, 0, 0]], 15)
    assert (contacts["a"] == 0).all()
    assert (contacts["b"] == 1).all()
    assert contacts["normal"][0] == pytest.approx([-1, 0], abs=1e-6)


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


def test_an_impact_gives_the_impulse_mass_times_speed():
    world = world_of(Robot(mass=2.0, drive=Unicycle(max_force=1e-6)), addons=[Map([wall_at(0.3)])])
    contacts = drive(world, [[0.4], [0]], 10)
    assert contacts["impulse"].sum() == pytest.approx(2.0 * 0.4, rel=1e-3)


def test_between_two_robots_a_push_is_the_weaker_drives_force():
    world = world_of(
        Robot(drive=Unicycle(max_force=5)),
        Robot(pose=(0.4, 0, np.pi), drive=Unicycle(max_force=5)),
    )
    contacts = drive(world, [[0.2, 0.2], [0, 0]], 100)
    assert contacts["impulse"][-20:] == pytest.approx(0.5, rel=0.02)


def test_obstacles_are_numbered_from_minus_one_down_over_all_addons():
    maps = [
        Map([wall_at(50), wall_at(60)], name="far"),
        Map([wall_at(70), wall_at(0.3)], name="near"),
    ]
    world = world_of(Robot(), addons=maps)
    contacts = drive(world, [[0.3], [0]], 10)
    assert len(contacts) > 0
    assert (contacts["b"] == -4).all()
    assert world.obstacles[3] == tuple(wall_at(0.3))


def test_the_walls_of_the_workspace_come_last():
    square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    maps = [Map([[(0.5, 5), (0.5, 6)], [(0.6, 5), (0.6, 6)]])]
    world = world_of(Robot(), addons=maps, workspace=square, on_exit="wall")
    contacts = drive(world, [[0.5], [0]], 30)
    assert len(contacts) > 0
    assert (contacts["b"] == -3).all()


def test_all_edges_of_an_obstacle_are_one_thing_with_a_row_for_each_normal():
    corner = [(0.3, -0.3), (0.3, 0.16), (-1, 0.16), (-1, 2), (2, 2), (2, -0.3)]
    robot = Robot(drive=Holonomic())
    world = world_of(robot, addons=[Map([corner])])
    contacts = drive(world, [[0.2], [0.2]], 20)
    assert set(contacts["b"]) == {-1}
    assert contacts["normal"][-2:] == pytest.approx(np.eye(2)[::-1], abs=1e-9)  # in the corner
    assert contacts["ended"].sum() == 0
    assert world.record.collisions == 1


def test_a_robot_between_two_others_makes_two_rows():
    world = world_of(Robot(), Robot(pose=(0.35, 0, 0)), Robot(pose=(0.7, 0, np.pi)))
    drive(world, [[0.2, 0, 0.2], [0, 0, 0]], 20)
    pairs = sorted((int(r["a"]), int(r["b"])) for r in world.contacts)
    assert pairs == [(0, 1), (1, 2)]


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


def test_a_robot_that_has_parted_makes_no_more_rows():
    world = world_of(Robot(), Robot(pose=(0.31, 0, np.pi)))
    drive(world, [[0.2, 0.2], [0, 0]], 10)
    drive(world, [[-0.2, -0.2], [0, 0]], 2)
    count = len(world.record.contacts)
    drive(world, [[-0.2, -0.2], [0, 0]], 10)
    assert len(world.record.contacts) == count


@each_case("gap", [0.0, 1e-15, -1e-15])
def test_robots_that_stand_at_exactly_zero_distance_are_no_trouble(gap):
    world = world_of(Robot(), Robot(pose=(0.3 + gap, 0, 0)), addons=[Map([wall_at(0.45)])])
    drive(world, [[0, 0], [0, 0]], 5)
    assert np.abs(world.pose[0] - [0, 0.3]).max() < 5e-5  # a quarter of the slop each


# -- the fields of a contact, as a run gives them -------------------------------------------------


def test_an_impact_has_the_speed_and_slip_at_which_the_surfaces_met():
    # It slides along the wall at 0.3 m/s as it comes towards it at 0.4 m/s; no friction turns it.
    robot = Robot(drive=Holonomic(max_force=1e-6), friction=0.0)
    world = world_of(robot, addons=[Map([wall_at(0.3)])])
    row = drive(world, [[0.4], [0.3]], 6)[0]
    assert row["began"]
    assert row["speed"] == pytest.approx(0.4, rel=1e-3)
    assert row["slip"] == pytest.approx(-0.3, rel=1e-3)  # of the wall along the robot
    assert row["normal_impulse"] == pytest.approx(0.4, rel=1e-3)
    assert abs(row["tangential_impulse"]) < 1e-9


def test_friction_is_the_tangential_impulse_and_bounded_by_mu_times_the_normal_one():
    robot = Robot(drive=Holonomic(max_force=2.0), friction=0.25)
    world = world_of(robot, addons=[Map([[(0.3, -9), (0.3, 9)]])])
    contacts = drive(world, [[0.4], [0.4]], 60)
    late = contacts[contacts["time"] > 3]
    assert len(late) > 20
    # The wall drags b, itself, along with the robot: +y, the normal turned by 90 degrees.
    ratio = late["tangential_impulse"] / late["normal_impulse"]
    assert ratio == pytest.approx(np.full(len(late), 0.25), rel=0.02)
    total = np.hypot(late["normal_impulse"], late["tangential_impulse"])
    assert late["impulse"] == pytest.approx(total, rel=1e-3)


def test_durations_add_up_to_the_time_in_touch():
    world = world_of(Robot(), addons=[Map([wall_at(0.3)])])
    contacts = drive(world, [[0.4], [0.0]], 20)
    touched = contacts["time"][0]
    assert contacts["duration"].sum() == pytest.approx(2.0 - touched, abs=5e-3)
    assert (contacts["duration"] <= 0.1 + 1e-12).all()


def test_a_bounce_begins_and_ends_and_is_one_episode():
    robot = Robot(drive=Holonomic(max_force=1e-6), restitution=1.0)
    world = world_of(robot, addons=[Map([wall_at(0.5)])])
    contacts = drive(world, [[0.4], [0.0]], 20)
    assert contacts["began"].sum() == 1
    assert contacts["ended"][-1]
    (episode,) = episodes(contacts)
    assert episode["speed"] == pytest.approx(0.4, rel=1e-3)
    assert episode["normal_impulse"] == pytest.approx(0.8, rel=0.02)
    assert 0 <= episode["ended"] - episode["began"] < 0.01


def test_episodes_join_the_steps_of_a_touch_and_keep_pairs_apart():
    rows = np.zeros(6, dtype=CONTACT)
    rows["time"] = [0.05, 0.1, 0.1, 0.2, 0.2, 0.5]
    rows["duration"] = [0.05, 0.1, 0.1, 0.03, 0.1, 0.01]
    rows["a"], rows["b"] = [0, 0, 1, 0, 1, 0], [-1, -1, 2, -1, 2, -1]
    rows["began"] = [True, False, True, False, False, True]
    rows["speed"] = [0.3, 0, 0.7, 0, 0, 0.1]
    rows["normal_impulse"] = [1, 2, 4, 8, 16, 32]
    rows["tangential_impulse"] = [-1, -2, -4, -8, -16, -32]
    found = episodes(rows)
    assert found["began"].tolist() == [0.05, 0.1, 0.5]
    assert found["ended"] == pytest.approx([0.23, 0.3, 0.51])
    assert list(zip(found["a"].tolist(), found["b"].tolist(), strict=True)) == [
        (0, -1), (1, 2), (0, -1),
    ]  # fmt: skip
    assert found["speed"].tolist() == [0.3, 0.7, 0.1]
    assert found["normal_impulse"].tolist() == [11, 20, 32]
    assert found["tangential_impulse"].tolist() == [-11, -20, -32]
    assert len(episodes(rows[:0])) == 0


def test_props_are_numbered_after_the_robots():
    props = [Puck(pose=(3, 3)), Box(pose=(0.5, 0, 0))]
    world = world_of(Robot(), Robot(pose=(0, 5, 0)), props=props)
    contacts = drive(world, [[0.3, 0], [0, 0]], 15)
    assert set(zip(contacts["a"].tolist(), contacts["b"].tolist(), strict=True)) == {(0, 3)}
    assert contacts["normal"][0] == pytest.approx([1, 0], abs=1e-6)


def test_two_props_and_a_prop_and_a_wall_make_contacts_too():
    props = [Puck(pose=(0, 0), velocity=(1, 0, 0), ground_friction=0.0),
             Puck(pose=(0.5, 0), ground_friction=0.0)]  # fmt: skip
    far = Robot(pose=(0, 5, 0))
    world = world_of(far, props=props, addons=[Map([wall_at(0.8)])])
    contacts = drive(world, [[0], [0]], 30)
    met = set(zip(contacts["a"].tolist(), contacts["b"].tolist(), strict=True))
    assert met == {(1, 2), (2, -1)}


@each_case("physics", ["stop", "ideal"])
def test_without_forces_contacts_are_reported_without_impulses(physics):
    world = world_of(Robot(), Robot(pose=(0.5, 0, np.pi)), physics=physics)
    contacts = drive(world, [[0.2, 0.2], [0, 0]], 12)
    assert contacts["time"][0] == pytest.approx(0.5, abs=5e-3)
    assert contacts["began"].sum() == 1
    assert contacts["speed"][0] == pytest.approx(0.4)
    assert not contacts["impulse"].any()
    assert (contacts["normal"] == pytest.approx(np.tile([1.0, 0], (len(contacts), 1)))) is True


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
