"""Hands on a running world: what they pull, place and drive, and what comes of it."""

from math import hypot

import numpy as np
import pytest

from mars2d import Holonomic, InputError, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.bodies.joints import Spring
from mars2d.bodies.props import Box, Puck
from tests.cases import each_case

WALL = Map([[(1.0, -3.0), (1.0, 3.0)]])
ROBOT = Robot(pose=(0, 0, 0))
CRATE = Box(length=0.5, width=0.5, mass=8.0)  # the floor holds it with 39.24 N


def straight(robot):
    return 0.3, 0.0


def pulled(scenario, body, target, grip=(0.0, 0.0), steps=40, **options):
    """The world, and the poses (steps, 3) of a body that is pulled to a target."""
    world = World(scenario)
    world.operator.pull(body, grip, target, **options)
    index = scenario.body_index_of("test", body)
    path = []
    for _ in range(steps):
        world.step()
        path.append(np.hstack([world.pose, world.prop_pose])[:, index])
    return world, np.array(path)


# -- pulling what is free --------------------------------------------------------------------


@each_case("drive", [Unicycle(), Holonomic()])
def test_a_robot_whose_law_stands_still_follows_the_pointer_and_never_swings_back(drive):
    _, path = pulled(Scenario(robots=[ROBOT.replace(drive=drive)]), 0, (2.0, 1.0))
    ways = np.hypot(*(path[:, :2] - (2.0, 1.0)).T)
    assert (np.diff(ways) <= 1e-12).all()
    assert ways[-1] < 0.01
    along = path[:, :2] @ (2.0, 1.0) / hypot(2, 1)
    assert along.max() <= hypot(2, 1)


def test_a_body_without_friction_is_brought_to_the_pointer_and_stops_there():
    free = Puck(name="puck", mass=5.0, ground_friction=0.0)
    scenario = Scenario(robots=[ROBOT.at(-4, -4)], props=[free])
    _, path = pulled(scenario, "puck", (2.0, 0.0), steps=80, force=5.0)
    assert path[:, 0].max() < 2.01  # a weak hand brakes in time
    assert hypot(path[-1, 0] - 2.0, path[-1, 1]) < 0.01


def test_the_way_does_not_depend_on_the_sampling_time_by_more_than_a_slice():
    ends = []
    for dt in (0.01, 0.1, 0.5):
        scenario = Scenario(robots=[ROBOT], sampling_time=dt)
        _, path = pulled(scenario, 0, (4.0, 0.0), steps=round(1 / dt))
        ends.append(path[-1, 0])
    assert np.ptp(ends) < 0.01


def test_the_strongest_and_quickest_pull_neither_hangs_nor_goes_through_walls():
    scenario = Scenario(robots=[ROBOT.replace(mass=0.1)], addons=[WALL], on_exit="ignore")
    _, path = pulled(scenario, 0, (900.0, 0.0), steps=20, force=1e6, speed=100.0)
    assert path[:, 0].max() <= 0.85 + scenario.max_overlap


# -- against drives and floors -----------------------------------------------------------------


@each_case("drive", [Unicycle(), Holonomic()])
@each_case("force", [0.5, 2.0, 4.9])
def test_a_pull_weaker_than_the_drive_leaves_a_robot_on_its_course(drive, force):
    robot = ROBOT.replace(drive=drive, controller=straight)
    world, path = pulled(Scenario(robots=[robot]), 0, (0.0, 4.5), force=force, steps=100)
    assert np.allclose(path[-1], (3.0, 0.0, 0.0), atol=1e-12)
    assert world.effort[0] == pytest.approx(force / 5.0)  # its drive bears all of it


def test_a_stronger_one_moves_it_as_newton_says():
    scenario = Scenario(robots=[ROBOT.at(-4, 0)], props=[CRATE])
    _, path = pulled(scenario, "box0", (4.0, 0.0), force=45.0, steps=20)
    assert path[-1, 0] == pytest.approx((45 - 39.24) / 8 * 2.0**2 / 2, rel=0.05)


# -- walls, crowds, joints ---------------------------------------------------------------------


def crowd(seed):
    """Twenty robots in a walled room, and where one of them is pulled to, (8, 2)."""
    rng = np.random.default_rng(seed)
    places = [(0.5 * (k % 5) - 1.0, 0.5 * (k // 5) - 0.75) for k in range(20)]
    robots = [Robot(pose=(x, y, rng.uniform(-3, 3)), controller=straight) for x, y in places]
    room = [(-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (-1.5, 1.5)]
    scenario = Scenario(robots=robots, workspace=room, on_exit="wall")
    return scenario, rng.uniform(-3, 3, (8, 2))


def test_nobody_escapes_from_a_crowd_that_one_is_pulled_through():
    for seed in range(12):
        scenario, targets = crowd(seed)
        world = World(scenario)
        for x, y in targets:
            world.operator.pull(7, (0.05, 0.1), (x, y), force=40.0, speed=5.0)
            world.step()
            reach = np.abs(world.pose[:2]).max()
            assert reach <= 1.5 - 0.15 + scenario.max_overlap, f"seed {seed}"
            place = world.position[0] + 1j * world.position[1]
            gaps = abs(place[:, None] - place) + 9 * np.eye(20)
            assert gaps.min() >= 0.3 - scenario.max_overlap, f"seed {seed}"


def test_a_spring_gives_way_as_far_as_the_hand_is_strong():
    spring = Spring(a="robot0", b="robot1", stiffness=20.0, damping=20.0)
    strong = ROBOT.replace(drive=Unicycle(max_force=50.0))
    weak = ROBOT.replace(drive=Unicycle(max_force=0.01))
    scenario = Scenario(robots=[weak.at(0.5, 0), strong.at(0, 0)], joints=[spring])
    _, path = pulled(scenario, 0, (4.0, 0.0), steps=80, force=10.0)
    assert path[-1, 0] == pytest.approx(0.5 + 10.0 / 20.0, abs=0.01)


# -- pushing ---------------------------------------------------------------------------------------


@each_case("duration", [0.5, 0.101, 0.02])
def test_a_push_gives_force_times_time_as_momentum_and_half_its_square_over_mass_as_work(duration):
    free = Puck(name="puck", mass=2.0, ground_friction=0.0)
    scenario = Scenario(robots=[ROBOT.at(-4, -4)], props=[free], sampling_time=0.04)
    world = World(scenario)
    world.operator.push("puck", (3.0, 4.0), duration)
    for _ in range(20):
        world.step()
    momentum = world.frame.momentum.linear[:, 1]
    assert momentum == pytest.approx([3.0 * duration, 4.0 * duration])
    assert world.frame.energy.by("hands") == pytest.approx((5.0 * duration) ** 2 / (2 * 2.0))
    assert world.operator.force(1) == 0.0  # it is over


def test_a_push_beside_the_middle_turns_a_body_and_pushes_add_up():
    crate = CRATE.replace(name="crate", ground_friction=0.0)
    world = World(Scenario(robots=[ROBOT.at(-4, -4)], props=[crate], sampling_time=0.01))
    world.operator.push("crate", (2.0, 0.0), 0.01, (0.0, 0.2))
    world.operator.push("crate", (0.0, 5.0), 0.01)
    world.step()
    assert world.operator.force(1) == pytest.approx(hypot(2.0, 5.0))
    spin = world.frame.exact_velocity[2, 1]
    assert spin == pytest.approx(-2.0 * 0.2 * 0.01 / crate.inertia.moment)


# -- placing -----------------------------------------------------------------------------------


def test_a_body_that_is_put_elsewhere_stands_still_there_and_goes_on():
    world = World(Scenario(robots=[ROBOT.replace(controller=straight), ROBOT.at(-2, -2)]))
    world.step()
    world.operator.place(0, (-1.0, 1.0, np.pi / 2))
    assert world.pose[:, 0].tolist() == [-1.0, 1.0, np.pi / 2]
    world.step()
    assert np.allclose(world.pose[:, 0], (-1.0, 1.03, np.pi / 2))
    assert world.record.pose[1, :, 0].tolist() == [-1.0, 1.0, np.pi / 2]


ROOM = [(-3, -3), (3, -3), (3, 3), (-3, 3)]


@each_case(
    ("pose", "words"),
    [
        ((1.0, 0.1, 0), "it would overlap blue"),
        ((0.0, 2.2, 0), "it would overlap crate"),
        ((-1.0, 0.0, 0), "it would be in obstacle 0"),
        ((2.9, 0.0, 0), "it would be in the workspace's wall"),
        ((9.0, 0.0, 0), "it would be outside of the workspace"),
    ],
)
def test_where_a_body_can_not_be_put_is_said_in_words_and_nothing_happens(pose, words):
    scenario = Scenario(
        robots=[Robot(name="red"), Robot(name="blue").at(1, 0)],
        props=[CRATE.replace(name="crate").at(0, 2)],
        addons=[Map([[(-1.2, -0.2), (-0.8, -0.2), (-0.8, 0.2), (-1.2, 0.2)]])],
        workspace=ROOM,
        on_exit="wall",
    )
    world = World(scenario)
    with pytest.raises(InputError, match=f"^red can't be put there: {words}$"):
        world.operator.place("red", pose)
    assert world.pose[:, 0].tolist() == [0, 0, 0]
    assert world.operator.log == []


# -- driving -------------------------------------------------------------------------------------


def test_a_robot_that_is_driven_has_the_hands_command_and_its_law_is_asked_all_the_same():
    asked = []

    def law(robot):
        asked.append(robot.time)
        return 0.1, 0.0

    world = World(Scenario(robots=[ROBOT.replace(controller=law)]))
    world.step()
    world.operator.steer("robot0", (0.4, 0.2))
    world.step()
    world.step()
    world.operator.steer(0, None)
    world.step()
    assert world.record.command[:, 0, 0].tolist() == [0.1, 0.4, 0.4, 0.1]
    assert world.record.command[:, 1, 0].tolist() == [0.0, 0.2, 0.2, 0.0]
    assert len(asked) == 4


# -- what can't be done ----------------------------------------------------------------------------


@each_case(
    ("act", "words"),
    [
        (
            lambda h: h.steer("rde", (0, 0)),
            "Operator.steer: there is no robot 'rde'; did you mean 'red'",
        ),
        (lambda h: h.steer("red", (1, 2, 3)), "expected two numbers"),
        (lambda h: h.steer("red", ("a", 0)), "expected two numbers"),
        (lambda h: h.place("red", (0, float("inf"), 0)), r"Operator.place\(pose\)"),
        (lambda h: h.pull(7, (0, 0), (1, 1)), "Operator.pull: there is no body 7; they are 0 to 1"),
        (lambda h: h.pull("red", (0, 0), (1, float("nan"))), r"Operator.pull\(target\)"),
        (lambda h: h.pull("red", (0, 0), (1, 1), force=1e9), "expected a number > 0 and <= 1e"),
        (lambda h: h.pull("red", (1e300, 0), (1, 1)), r"Operator.pull\(grip\)"),
        (lambda h: h.push("red", (0, 0), 0.5), r"Operator.push\(force\) = \(0, 0\): expected more"),
        (lambda h: h.hold("blu"), "World.hold: there is no robot 'blu'"),
    ],
)
def test_what_makes_no_sense_is_refused_and_nothing_happens(act, words):
    world = World(Scenario(robots=[Robot(name="red"), Robot(name="blue").at(1, 0)]))
    with pytest.raises(InputError, match=words):
        act(world.operator)
    assert world.operator.log == []
    assert world.operator.driven == {}
    world.step()


@each_case("physics", ["stop", "ideal"])
def test_where_no_forces_act_nothing_can_be_pulled_but_put_elsewhere(physics):
    world = World(Scenario(robots=[ROBOT], physics=physics))
    with pytest.raises(InputError, match=f"can't be pulled: with physics = '{physics}' no forces"):
        world.operator.pull(0, (0, 0), (1, 1))
    with pytest.raises(InputError, match="no forces act"):
        world.operator.push(0, (1, 1), 0.5)
    world.operator.place(0, (1, 1, 1))
    world.step()
    assert world.pose[:, 0].tolist() == [1, 1, 1]
