"""Contacts are reported as rows: who, when, where, which way and how hard."""

from __future__ import annotations

import numpy as np
import pytest

from mars2d import Holonomic, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.contact import CONTACT, ContactLog


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
    world = world_of(Robot(), Robot(pose=(0.5, 0, np.pi)))
    contacts = drive(world, [[0.2, 0.2], [0, 0]], 20)
    assert set(zip(contacts["a"].tolist(), contacts["b"].tolist(), strict=True)) == {(0, 1)}
    # The gap of 0.2 m closes at 0.4 m/s: they meet after 0.5 s.
    assert contacts["time"][0] == pytest.approx(0.5, abs=5e-3)
    assert len(contacts) == pytest.approx(15, abs=1)
    steps = np.floor(contacts["time"] / 0.1 - 1e-9)
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


@pytest.mark.parametrize("sampling_time", [0.05, 0.1, 1.0])
@pytest.mark.parametrize("force", [2.0, 5.0])
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


def test_all_edges_of_an_obstacle_are_one_thing():
    corner = [(0.3, -0.3), (0.3, 0.16), (-1, 0.16), (-1, 2), (2, 2), (2, -0.3)]
    robot = Robot(drive=Holonomic())
    world = world_of(robot, addons=[Map([corner])])
    contacts = drive(world, [[0.2], [0.2]], 20)
    assert set(contacts["b"]) == {-1}
    steps = np.floor(contacts["time"] / 0.1 - 1e-9)
    assert len(np.unique(steps)) == len(contacts)  # pressed in the corner, still one row a step


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


@pytest.mark.parametrize("gap", [0.0, 1e-15, -1e-15])
def test_robots_that_stand_at_exactly_zero_distance_are_no_trouble(gap):
    world = world_of(Robot(), Robot(pose=(0.3 + gap, 0, 0)), addons=[Map([wall_at(0.45)])])
    drive(world, [[0, 0], [0, 0]], 5)
    assert np.abs(world.pose[0] - [0, 0.3]).max() < 1e-6


def test_a_log_sums_the_substeps_of_a_pair_as_vectors():
    log = ContactLog(np.array([0, 0, 1]))
    none = np.empty(0, dtype=np.int64)
    touching = (none, none, np.array([0]), np.array([2]))
    for time, impulse in ((0.1, (3.0, 0.0)), (0.2, (0.0, 4.0))):
        values = np.array([[*impulse, 1, 0, 0.1, 0.2, 0.3, 0.4]])
        log.add(time, np.array([[0, -2]]), values, touching)
    rows = log.take()
    assert len(rows) == 1
    assert rows["time"][0] == 0.1
    assert (rows["a"][0], rows["b"][0]) == (0, -2)
    assert rows["impulse"][0] == pytest.approx(5.0)
    assert rows["began"][0]
    assert len(log.take()) == 0


def test_a_log_turns_pairs_round_and_leaves_out_those_that_do_not_touch():
    log = ContactLog(np.array([0]))
    none = np.empty(0, dtype=np.int64)
    touching = (np.array([2]), np.array([1]), none, none)
    bodies = np.array([[2, 1], [-1, 2]])
    values = np.array([[1.0, 0, 1, 0, 0.1, 0.2, 0.3, 0.4], [9.0, 0, 1, 0, 5, 5, 5, 5]])
    log.add(0.0, bodies, values, touching)
    rows = log.take()
    assert [(int(r["a"]), int(r["b"])) for r in rows] == [(1, 2)]
    assert rows["normal"][0].tolist() == [-1, 0]
    assert rows["point"][0].tolist() == [0.3, 0.4]


def test_the_order_in_which_the_solver_lists_contacts_does_not_matter():
    # It depends on addresses in memory. Two edges of one obstacle touch the same robot.
    rng = np.random.default_rng(0)
    listed = [np.array([0.1, 0.3, *rng.normal(size=6)]), np.array([7.0, 0.2, *rng.normal(size=6)]),
              np.array([0.7, 0.1, *rng.normal(size=6)])]  # fmt: skip
    none = np.empty(0, dtype=np.int64)
    results = []
    for order in ([0, 1, 2], [2, 1, 0], [1, 2, 0]):
        log = ContactLog(np.array([0]))
        values = np.array([listed[k] for k in order])
        log.add(0.5, np.full((3, 2), [0, -1]), values, (none, none, np.array([0]), np.array([0])))
        results.append(log.take().tobytes())
    assert len(set(results)) == 1
    row = np.frombuffer(results[0], dtype=CONTACT)[0]
    assert row["normal"].tolist() == listed[1][2:4].tolist()  # that of the strongest
