"""A scenario is complete by its defaults, and holds only what can be simulated truthfully."""

from __future__ import annotations

import copy
import inspect
import pickle
from itertools import pairwise

import numpy as np
import pytest

from mars2d import Animation, Holonomic, InputError, Robot, Scenario, Unicycle
from mars2d.addons import Addon, Map
from mars2d.sensors import Proximity

SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]


def wall(x: float) -> Map:
    return Map([[(x, -1), (x, 1)]])


def test_one_robot_is_a_complete_scenario():
    scenario = Scenario(robots=[Robot(pose=(0, 0, 0))])
    assert scenario.bounds == (-5, 5, -5, 5)
    assert scenario.sampling_time == 0.1
    assert scenario.robots[0].name == "robot0"
    assert scenario.obstacles == ()


def test_even_nothing_at_all_is_a_complete_scenario():
    assert len(Scenario().robots) == 1


def test_the_defaults_are_those_of_the_paper():
    scenario = Scenario()
    assert scenario.title == "[Simulation]"
    assert scenario.command_delay == 0
    assert scenario.stop_time == 100
    robot = scenario.robots[0]
    assert (robot.diameter, robot.mass, robot.friction, robot.restitution) == (0.3, 1, 0.5, 0)
    assert isinstance(robot.drive, Unicycle)


def test_a_number_of_robots_stands_on_a_circle_facing_its_centre():
    scenario = Scenario(robots=4)
    x, y, theta = scenario.initial_pose
    assert np.hypot(x, y) == pytest.approx([3.5] * 4)
    assert np.cos(theta) == pytest.approx(-x / 3.5)
    assert np.sin(theta) == pytest.approx(-y / 3.5)


def test_at_copies_a_robot_elsewhere():
    walker = Robot(diameter=0.2, name="a")
    there = walker.at(1, 2, 3)
    assert there.pose == (1, 2, 3)
    assert there.diameter == 0.2
    assert walker.pose == (0, 0, 0)


def test_the_geometric_centre_lies_behind_the_centre_of_rotation():
    assert Robot(pose=(1, 2, np.pi / 2), center_offset=0.1).center == pytest.approx((1, 1.9))


def test_robots_without_a_name_get_one_that_is_free():
    robots = [Robot(name="robot1"), Robot(pose=(1, 0, 0)), Robot(pose=(2, 0, 0))]
    assert [r.name for r in Scenario(robots=robots).robots] == ["robot1", "robot1_", "robot2"]


def test_two_robots_or_addons_of_one_name_are_refused():
    with pytest.raises(InputError, match="two are called 'a'"):
        Scenario(robots=[Robot(name="a"), Robot(name="a", pose=(1, 0, 0))])
    with pytest.raises(InputError, match=r"two are called 'map'.*give one another name"):
        Scenario(addons=[wall(1), wall(2)])
    assert len(Scenario(addons=[wall(1), wall(2).replace(name="second")]).obstacles) == 2


def test_a_misspelt_field_gives_the_nearest_name():
    with pytest.raises(InputError, match=r"Scenario has no field 'robot'; did you mean 'robots'"):
        Scenario(robot=[Robot()])
    with pytest.raises(InputError, match=r"did you mean 'diameter'"):
        Robot(diametr=0.3)
    with pytest.raises(InputError, match=r"did you mean 'max_linear_speed'"):
        Unicycle(max_speed=1)


@pytest.mark.parametrize(
    ("robots", "fields", "problem"),
    [
        ([Robot(), Robot(pose=(0.2, 0, 0))], {}, "robot0 .* and of robot1 .* inside each other"),
        ([Robot(pose=(9, 0, 0))], {}, "robot0 .* starts outside the workspace"),
        ([Robot(pose=(4.9, 0, 0))], {"on_exit": "wall"}, "starts in the workspace's wall"),
        ([Robot()], {"addons": [wall(0.1)]}, "in contact with obstacle 0"),
        ([Robot()], {"addons": [Map([SQUARE])]}, "inside obstacle 0.*draw it as walls"),
        ([Robot(), Robot(pose=(1, 0, 0), mass=11)], {}, "ratio of at most 10"),
        ([Robot()], {"stop_time": 1e9, "sampling_time": 1e-3}, "sampling times of 0.001 s"),
    ],
)
def test_what_could_not_start_is_refused_with_the_reason(robots, fields, problem):
    with pytest.raises(InputError, match=problem):
        Scenario(robots=robots, **fields)


@pytest.mark.parametrize(
    ("robots", "fields"),
    [
        ([Robot(), Robot(pose=(0.3, 0, 0))], {}),
        ([Robot(), Robot(pose=(0.2995, 0, 0))], {}),
        ([Robot(pose=(9, 0, 0))], {"on_exit": "ignore"}),
        ([Robot(pose=(9, 0, 0))], {"workspace": None}),
        ([Robot(pose=(4.9, 0, 0))], {"on_exit": "stop"}),
        ([Robot(pose=(4.85, 0, 0))], {"on_exit": "wall"}),
        ([Robot()], {"addons": [wall(0.15)]}),
        ([Robot(), Robot(pose=(1, 0, 0), mass=10)], {}),
        # in the notch of a concave obstacle, which its convex hull would fill
        ([Robot(pose=(0.2, 1, 0), diameter=0.1)],
         {"addons": [Map([[(0, 0), (-1, 1), (1, 2), (0, 1)]])]}),
        # in a room that is drawn as walls
        ([Robot()], {"addons": [Map([[a, b] for a, b in pairwise(SQUARE)])]}),
    ],
)  # fmt: skip
def test_what_can_start_is_accepted(robots, fields):
    assert Scenario(robots=robots, **fields)


@pytest.mark.parametrize("axis", [0, 1])
def test_thousands_of_robots_in_a_row_are_checked_quickly(axis):
    places = np.zeros((2000, 2))
    places[:, axis] = np.arange(2000)
    robots = [Robot(pose=(x, y, 0)) for x, y in places]
    assert len(Scenario(robots=robots, workspace=None).robots) == 2000
    robots[1500] = robots[1500].at(*(places[1499] + 0.1))
    with pytest.raises(InputError, match=r"robot1499 .* robot1500"):
        Scenario(robots=robots, workspace=None)


@pytest.mark.parametrize(
    ("stop_time", "sampling_time", "iterations"),
    [(0, 0.1, 0), (1, 0.1, 10), (0.3, 0.1, 3), (0.99, 0.1, 9), (1000, 1, 1000), (100, 0.3, 333),
     (0.05, 0.1, 0), (1e4, 1e-3, 10_000_000)],
)  # fmt: skip
def test_the_last_iteration_is_the_last_that_is_not_after_the_stop_time(
    stop_time, sampling_time, iterations
):
    scenario = Scenario(stop_time=stop_time, sampling_time=sampling_time)
    assert scenario.last_iteration == iterations


def test_initial_poses_are_columns():
    scenario = Scenario(robots=[Robot(pose=(1, 2, 3)), Robot(pose=(4, 5, 6))], workspace=None)
    assert scenario.initial_pose.tolist() == [[1, 4], [2, 5], [3, 6]]


def test_without_a_workspace_the_bounds_hold_robots_and_obstacles():
    scenario = Scenario(robots=[Robot(pose=(7, 0, 0))], workspace=None, addons=[wall(-3)])
    assert scenario.bounds == (-4, 8, -2, 2)


def test_colours_are_the_robots_own_or_the_next_of_the_base_colours():
    robots = [Robot(), Robot(pose=(1, 0, 0), color="red"), Robot(pose=(2, 0, 0))]
    scenario = Scenario(robots=robots, animation=Animation(base_colors=["k", "#123456"]))
    assert scenario.colors == ("#000000", "#d62728", "#000000")


@pytest.mark.parametrize("speed", [0, 1, 2.5, "max", np.float32(3), np.int64(2)])
def test_a_playback_speed_is_a_factor_or_max(speed):
    assert Animation(playback_speed=speed).playback_speed == speed


def test_a_scenario_can_be_hashed_compared_copied_and_sent_to_a_worker():
    scenario = Scenario(
        robots=[Robot(sensors=[Proximity(range=1)]), Robot(pose=(1, 0, 0), drive=Holonomic())],
        addons=[wall(3)],
        title="x",
    )
    for twin in (pickle.loads(pickle.dumps(scenario)), copy.deepcopy(scenario), scenario.replace()):
        assert twin == scenario
        assert hash(twin) == hash(scenario)
        assert twin.obstacles == scenario.obstacles
    assert scenario != scenario.replace(title="y")


def test_a_scenario_does_not_change_when_what_it_was_made_of_does():
    corners = np.array(SQUARE, dtype=float)
    robots = [Robot()]
    scenario = Scenario(robots=robots, workspace=corners)
    corners[:] = 0
    robots.clear()
    assert scenario.bounds == (-1, 1, -1, 1)
    assert len(scenario.robots) == 1


def test_obstacles_of_an_addon_are_asked_for_once():
    class Random(Addon):
        def obstacles(self):
            return [[(2, y), (3, y)] for y in np.random.default_rng().uniform(0, 1, 1)]

    scenario = Scenario(addons=[Random()])
    assert scenario.obstacles == scenario.obstacles


def test_a_concave_obstacle_is_kept_vertex_by_vertex():
    concave = [(5, 2), (4, 3), (6, 4), (5, 3)]
    scenario = Scenario(addons=[Map([concave])])
    assert scenario.obstacles == (tuple(concave),)


def test_every_field_has_a_meaning_and_no_law_is_called_by_a_constructor():
    for kind in (Scenario, Robot, Animation, Unicycle, Holonomic, Map, Proximity):
        for name, field in kind.__dataclass_fields__.items():
            if "ClassVar" not in str(field.type):
                assert field.metadata["doc"], f"{kind.__name__}.{name}"
        assert inspect.getdoc(kind)

    def law(robot):
        raise AssertionError

    assert Robot(controller=law).controller is law
