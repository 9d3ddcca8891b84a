"""The scenes of the benchmarks, the gaps between their bodies, and the bare loop beside them."""

import numpy as np
import pytest
from gaps import Gaps
from scenes import FORCE, LEVER, SCENES, TORQUE, Scene
from worlds import SETTINGS, deepest, world_of
from yardstick import Bare

from tests.cases import each_case

# -- scenes ---------------------------------------------------------------------------------------


@each_case("name", SCENES)
def test_a_scene_is_the_same_each_time_and_nothing_touches_in_it(name):
    scene, again = SCENES[name](), SCENES[name]()
    assert scene.name == name
    assert np.array_equal(scene.poses, again.poses)
    assert np.array_equal(scene.crates, again.crates)
    assert (scene.boxes, scene.ropes) == (again.boxes, again.ropes)
    starts = np.concatenate([scene.poses, scene.crates])
    assert deepest(scene, starts.T[None]) == 0
    assert np.abs(starts[:, :2]).max() < scene.side / 2 - scene.radius


@each_case("name, robots, crates", [("P1", 20, 30), ("P2", 60, 0), ("P3", 10, 5)])
def test_a_world_of_contacts_has_its_robots_crates_and_ropes(name, robots, crates):
    scene = SCENES[name]()
    world = world_of(scene, SETTINGS["loose"])
    assert (world.scenario.max_overlap, world.scenario.sampling_time) == (0.02, scene.sampling_time)
    assert (len(world.robots), len(world.props)) == (robots, crates)
    assert set(scene.half_sides[:robots]) == {0.15 if name == "P2" else 0}
    drives = {(robot.drive.max_force, robot.drive.max_torque) for robot in world.scenario.robots}
    assert drives == {(FORCE, TORQUE)}
    for crate in world.scenario.props:
        assert crate.side_lengths == (0.4, 0.4)
        assert crate.inertia.mass == 1
        lever = crate.shape.plate.lever
        assert lever == pytest.approx(LEVER)  # by which other engines hold it
    world.step()
    assert np.abs(world.command[1]).max() > 1.5
    for i, k, length in scene.ropes:
        apart = np.hypot(*(scene.poses[i] - scene.crates[k])[:2])
        assert length == pytest.approx(1.5 * apart)
        rope = world.scenario.joints[i]
        assert (rope.a, rope.b, rope.length) == (f"robot{i}", f"box{k}", length)
    assert len(scene.ropes) == len(world.scenario.joints)


# -- the yardstick --------------------------------------------------------------------------------


def test_the_bare_loop_moves_free_robots_as_a_world_does():
    scene = Scene("free", "", 0.05, 50.0, np.array([[-5.0, 0, 1], [5, 3, 2]]), [])
    world, bare = world_of(scene), Bare(scene, 3)
    for _ in range(40):
        world.step()
        bare()
    assert np.abs(world.pose - scene.poses.T).max() > 0.3
    assert bare.pose == pytest.approx(world.pose, abs=1e-9)


# -- overlaps -------------------------------------------------------------------------------------

BOX = [(1.0, -0.5), (1.0, 0.5), (2.0, 0.5), (2.0, -0.5)]


@each_case(
    "places, expected",
    [
        ([(0, 0), (0, 1)], 0.0),
        ([(0, 0), (0, 0.28)], 0.02),  # each other
        ([(0.87, 0), (0, 1)], 0.02),  # the box
        ([(1.0, 0), (0, 1)], 0.15),
        ([(0, 0), (-2.9, 2.86)], 0.05),  # a wall, and another
    ],
)
def test_the_deepest_overlap_is_that_which_one_works_out(places, expected):
    scene = Scene("", "", 0.1, 6.0, np.zeros((2, 3)), [BOX])
    pose = np.array([(*place, 0.3) for place in places]).T
    apart = np.array([(-1.0, 0, 0), (-2, 0, 0)]).T
    assert deepest(scene, np.array([apart, pose, apart])) == pytest.approx(expected, abs=1e-12)


SQUARES = Scene("", "", 0.1, 6.0, np.zeros((1, 3)), [BOX], square=True, crates=np.zeros((1, 3)))
"""A robot of 0.3 m and a crate of 0.4 m, both squares."""


@each_case(
    "robot, crate, expected",
    [
        ((0, 0, 0), (0.36, 0, 0), (0.01, 0.85)),  # apart by a face
        ((0, 0, 0), (0.34, 0.1, np.pi / 2), (-0.01, 0.85)),
        ((-1, 0, np.pi / 4), (-1, 0.45, np.pi / 4), (0.45 * 0.5**0.5 - 0.35, 1)),
        ((-1, 0, 0), (-1, 0.42, np.pi / 4), (0.42 - 0.15 - 0.08**0.5, 1)),  # by a corner
        ((-2.9, 0, 0), (0, 0, 0), (1, -0.05)),  # in a wall
        ((-2.8, 0, np.pi / 4), (0, 0, 0), (1, 0.2 - 0.15 * 2**0.5)),
        ((0.9, 0.2, 0), (-1, 0, 0), (1, -0.05)),  # in the box
    ],
)
def test_gaps_of_squares_are_those_which_one_works_out(robot, crate, expected):
    among, fixed = Gaps(SQUARES)(np.array([robot, crate], float), within=1.0)
    assert among == pytest.approx([expected[0]] * 2)
    assert fixed[0] == pytest.approx(expected[1])
