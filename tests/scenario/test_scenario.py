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
from mars2d.bodies.joints import Hinge, Joint, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Gate, Prop, Puck, Solid
from mars2d.bodies.rigid import Inertia
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.scenario.experiment import open_experiment
from mars2d.sensors import Proximity
from tests.cases import each_case
from tests.worlds import ELL

SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]


def wall(x: float) -> Map:
    return Map([[(x, -1), (x, 1)]])


def test_one_robot_is_a_complete_scenario():
    scenario = Scenario(robots=[Robot(pose=(0, 0, 0))])
    assert scenario.bounds == (-5, 5, -5, 5)
    assert scenario.sampling_time == 0.1
    assert scenario.robots[0].name == "robot0"
    assert scenario.obstacles == ()


def test_a_number_of_robots_stands_on_a_circle_facing_its_centre():
    scenario = Scenario(robots=4)
    x, y, theta = scenario.initial_pose
    assert np.hypot(x, y) == pytest.approx([3.5] * 4)
    assert np.cos(theta) == pytest.approx(-x / 3.5)
    assert np.sin(theta) == pytest.approx(-y / 3.5)


def test_robots_without_a_name_get_one_that_is_free():
    robots = [Robot(name="robot1"), Robot(pose=(1, 0, 0)), Robot(pose=(2, 0, 0))]
    assert [r.name for r in Scenario(robots=robots).robots] == ["robot1", "robot1_", "robot2"]


def test_two_robots_or_addons_of_one_name_are_refused():
    with pytest.raises(InputError, match="two are called 'a'"):
        Scenario(robots=[Robot(name="a"), Robot(name="a", pose=(1, 0, 0))])
    with pytest.raises(InputError, match=r"two are called 'map'.*give one another name"):
        Scenario(addons=[wall(1), wall(2)])
    assert len(Scenario(addons=[wall(1), wall(2).replace(name="second")]).obstacles) == 2


@each_case(
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


@each_case(
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


@each_case("axis", [0, 1])
def test_hundreds_of_robots_in_a_row_are_compared_with_those_beside_them(axis):
    places = np.zeros((300, 2))
    places[:, axis] = np.arange(300)
    robots = [Robot(pose=(x, y, 0)) for x, y in places]
    assert len(Scenario(robots=robots, workspace=None).robots) == 300
    robots[250] = robots[250].at(*(places[249] + 0.1))
    with pytest.raises(InputError, match=r"robot249 .* robot250"):
        Scenario(robots=robots, workspace=None)


@each_case(
    ("stop_time", "sampling_time", "iterations"),
    [(0, 0.1, 0), (1, 0.1, 10), (0.3, 0.1, 3), (0.99, 0.1, 9), (1000, 1, 1000), (100, 0.3, 333),
     (0.05, 0.1, 0), (1e4, 1e-3, 10_000_000)],
)  # fmt: skip
def test_the_last_iteration_is_the_last_that_is_not_after_the_stop_time(
    stop_time, sampling_time, iterations
):
    scenario = Scenario(stop_time=stop_time, sampling_time=sampling_time)
    assert scenario.last_iteration == iterations


def test_without_a_workspace_the_bounds_hold_robots_and_obstacles():
    scenario = Scenario(robots=[Robot(pose=(7, 0, 0))], workspace=None, addons=[wall(-3)])
    assert scenario.bounds == (-4, 8, -2, 2)


def test_colours_are_the_robots_own_or_the_next_of_the_base_colours():
    robots = [Robot(), Robot(pose=(1, 0, 0), color="red"), Robot(pose=(2, 0, 0))]
    scenario = Scenario(robots=robots, animation=Animation(base_colors=["k", "#123456"]))
    assert scenario.colors == ("#000000", "#d62728", "#000000")


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


def test_obstacles_of_an_addon_are_asked_for_once():
    class Random(Addon):
        def obstacles(self):
            return [[(2, y), (3, y)] for y in np.random.default_rng().uniform(0, 1, 1)]

    scenario = Scenario(addons=[Random()])
    assert scenario.obstacles == scenario.obstacles


def test_every_field_has_a_meaning_and_no_law_is_called_by_a_constructor():
    kinds = (Scenario, Robot, Animation, Unicycle, Holonomic, Map, Proximity, Ball, Bar, Box, Gate,
             Puck, Solid, Hinge, Rod, Rope, Spring, Disc, Polygon, Compound)  # fmt: skip
    for kind in kinds:
        for name, field in kind.__dataclass_fields__.items():
            if "ClassVar" not in str(field.type):
                assert field.metadata["doc"], f"{kind.__name__}.{name}"
        assert inspect.getdoc(kind)

    def law(robot):
        raise AssertionError

    assert Robot(controller=law).controller is law


# -- props, shapes and joints ---------------------------------------------------------------------


def refused(message: str, **fields) -> None:
    with pytest.raises(InputError, match=message):
        Scenario(**fields)


def test_props_are_named_by_kind_and_place_and_never_like_another():
    props = [Box(pose=(1, 0)), Ball(pose=(2, 0)), Box(pose=(3, 0)), Puck(pose=(4, 0), name="box4"),
             Box(pose=(1, 2))]  # fmt: skip
    scenario = Scenario(robots=[Robot(name="ball1")], props=props)
    assert [p.name for p in scenario.props] == ["box0", "ball1_", "box2", "box4", "box4_"]


def test_bodies_are_the_robots_then_the_props():
    props = [Puck(pose=(1, 0, 2), velocity=(1, 2, 3), mass=2)]
    first, second = Scenario(robots=[Robot()], props=props).bodies
    assert (first.kind, first.name, first.velocity) == ("Robot", "robot0", (0, 0, 0))
    assert (second.kind, second.name, second.velocity) == ("Puck", "puck0", (1, 2, 3))
    assert second.inertia == (2, 2 * 0.1**2 / 2)


@each_case(
    ("fields", "message"),
    [
        (
            {"props": [Box(pose=(1, 0), material="steel")]},
            ("box0 has 125.6 kg and robot0 1 kg; contacts hold a ratio of at most 10: set the mass "
            "of box0 to 10 kg or less, or that of robot0 to 12.6 kg or more"),
        ),
        (
            {"robots": [Robot(mass=1e6)],
             "props": [Box(pose=(1, 0), length=0.5, width=1.5, material="steel", height=1e3)]},
            "Box.mass of box0 = 5887500.0: expected a mass .*; give one",
        ),
        (
            {"props": [Box(pose=(1, 0), moment=1.0)]},
            r"Box.moment of box0 = 1.0: expected .*mass x \(greatest distance\)\^2",
        ),
        (
            {"props": [Box(pose=(1, 0), velocity=(99, 0, 9))]},
            "Box.velocity of box0 = .*no point of it faster than 100 m/s; one has 101.5 m/s",
        ),
        (
            {"props": [Puck(pose=(1, 0), velocity=(20, 0))], "max_overlap": 1e-5},
            "no point of it faster than 10 m/s, as max_overlap is 1e-05 m",
        ),
        (
            {"robots": [Robot(drive=Unicycle(max_force=1e5))], "max_overlap": 1e-5},
            r"Scenario.max_overlap = 1e-05: expected at least 0.0001 m.*100000 N and robot0 has 1",
        ),
        (
            {"robots": [Robot(shape=ELL, drive=Unicycle(max_linear_speed=50))]},
            "robot0.drive: Unicycle turns at up to 500 rad/s",
        ),
        (
            {"props": [Box(pose=(1, 0)), Box(pose=(1.2, 0.2, 0.7))]},
            r"Box.pose of box0 = \(1.0, 0.0, 0.0\) and of box1 = .*inside each other",
        ),
        ({"props": [Solid(ELL, pose=(0.3, 0.3))]}, "robot0 .* and of solid0"),
        (
            {"props": [Gate(pose=(4.8, 0))], "on_exit": "wall"},
            "Gate.pose of gate0 = .*: starts in the workspace's wall",
        ),
        (
            {"props": [Box(pose=(2, 0))], "addons": [wall(2.1)]},
            "Box.pose of box0 = .*in contact with obstacle 0",
        ),
    ],
)  # fmt: skip
def test_a_body_that_cannot_be_held_is_refused_with_its_name_and_the_reason(fields, message):
    refused(message, **fields)


def test_props_may_lie_in_the_notch_of_another_one():
    ell = Solid(ELL, pose=(2, 0))
    x, y = ELL.centroid
    notch = Puck(pose=(2 - x + 0.4, 0.4 - y), diameter=0.2)
    assert len(Scenario(props=[ell, notch]).props) == 2
    refused("inside each other", props=[ell, notch.at(2 - x + 0.1, 0.4 - y)])


JOINTED = {"robots": [Robot(), Robot(pose=(1, 0, 0))], "props": [Box(pose=(0, 1, 0))]}


@each_case(
    ("joint", "message"),
    [
        (Rope(a="robto0", b="box0"), r"joints\[0\].a = 'robto0': .*did you mean 'robot0'"),
        (Rope(a="robot0", b="bax0"), r"joints\[0\].b = 'bax0': .*did you mean 'box0'"),
        (Rope(a="xyz", b="box0"), "known: box0, robot0, robot1"),
        (Rod(a="box0", b="box0"), "b = 'box0': expected another body than a"),
        (Rope(a="robot0", b="robot1", length=0.5),
         r"joints\[0\].length = 0.5: .*\(0, 0\) and \(1, 0\).*start 1 m apart; expected at least"),
        (Rod(a="robot0", b="robot1", length=1.5), "start 1 m apart; expected just that, or None"),
        (Rod(a="robot0"), "length = 0.0: expected a number >= 0.001 .*Hinge"),
        (Rope(a="robot0", length=1e-9), "length = 1e-09: expected a number >= 0.001"),
        (Hinge(a="robot0", b="robot1", anchor_a=(0.5, 0), anchor_b=(-0.4, 0)),
         r"its anchors, \(0.5, 0\) and \(0.6, 0\) in the world, lie 0.1 m apart"),
        (Spring(a="robot0", b="box0", stiffness=9e5),
         "stiffness = 900000.0: expected at most 5e.05"),
        (Spring(a="robot0", b="box0", stiffness=1e5, rest_length=10),
         "rest_length = 10.0: .*would throw its bodies at 4.02e.03 m/s"),
        (Hinge(a="robot0", stiffness=5e4), "stiffness = 50000.0: expected at most 1.1.e.04"),
        (Rope(a="robot0", b="box0", anchor_a=(3, 0)),
         "anchor_a = .* a point within 1.5 m of robot0"),
        (Joint(a="robot0"), "expected a Rope, Rod, Spring or Hinge"),
    ],
)  # fmt: skip
def test_a_joint_that_cannot_hold_is_refused_with_the_reason(joint, message):
    refused(message, **JOINTED, joints=[joint])


def test_joints_that_can_hold_are_accepted():
    joints = [
        Rope(a="robot0", b="box0"), Rope(a="robot0", b="robot1", length=3),
        Rod(a="robot1", anchor_b=(2, 2)), Spring(a="box0", anchor_b=(-1, 1), rest_length=0),
        Hinge(a="robot0", b="robot1", anchor_a=(0.5, 0), anchor_b=(-0.5, 0)),
    ]  # fmt: skip
    scenario = Scenario(**JOINTED, joints=joints)
    assert [tie.length for tie in scenario.ties] == pytest.approx([1, 3, np.sqrt(5), 0, 0])
    assert scenario.joined == {(0, 1)}


def test_bodies_on_one_hinge_may_overlap_and_others_not():
    robots = [Robot(), Robot(pose=(0.2, 0, 0))]
    pin = Hinge(a="robot0", b="robot1", anchor_a=(0.1, 0), anchor_b=(-0.1, 0))
    assert Scenario(robots=robots, joints=[pin]).joined == {(0, 1)}
    refused("inside each other", robots=robots, joints=[Rod(a="robot0", b="robot1")])


def test_a_prop_of_the_users_own_is_checked_like_any_other():
    class Beside(Prop):
        @property
        def shape(self):
            return Disc(0.2).moved(0.05, 0)

    class Heavy(Box):
        @property
        def inertia(self):
            return Inertia(float("nan"), 1.0)

    refused(r"Beside.shape of beside0: its centre of mass lies at \(0.05, 0\)", props=[Beside()])
    refused("Heavy.mass of heavy0 = nan", props=[Heavy(pose=(1, 0))])
    refused(r"prop 'prop0' raised NotImplementedError: Prop must say", props=[Prop(pose=(1, 0))])


# -- options --------------------------------------------------------------------------------------


@each_case(
    ("name", "option", "message"),
    [
        ("pursuit_corners", {"mu": "0,9"}, "scenario(mu) = '0,9': expected a number; its default"),
        ("pursuit_corners", {"mu": (0, 9)}, "scenario(mu) = (0, 9): expected a number"),
        ("herding", {"flock": None}, "scenario(flock) = None: expected a number"),
        ("coverage_square", {"holonomic": "false"}, "scenario(holonomic) = 'false': expected True"),
        ("cyclic_pursuit", {"n": 2.5}, "cyclic_pursuit.py, line 34, with n = 2.5: TypeError"),
        ("pursuit_voronoi", {"ratio": -1}, "with ratio = -1: Unicycle.max_linear_speed = -0.2"),
    ],
)
def test_what_a_scenario_function_cannot_use_is_named(name, option, message):
    with pytest.raises(InputError) as caught:
        open_experiment(name, option)
    assert message in str(caught.value)
