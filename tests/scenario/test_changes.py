"""What of a scenario may change while its world runs, and what needs a new start."""

import numpy as np
import pytest

from mars2d import Animation, Holonomic, InputError, Robot, Scenario, Unicycle, Within, World
from mars2d.addons import Communication, Game, Map
from mars2d.bodies.joints import Rope, Spring
from mars2d.bodies.props import Box, Puck
from mars2d.sensors import Proximity
from mars2d.world.verify import rerun
from tests.cases import each_case

RED, BLUE = Robot(name="red"), Robot(name="blue", pose=(2, 0, 0))
BLOCK = Map([[(1.0, 1.0), (1.5, 1.0), (1.5, 1.5)]], name="block")
BOX = Box(pose=(-2, 0, 0), name="crate")
BEFORE = Scenario(robots=[RED, BLUE], props=[BOX])


def forward(robot):
    return 0.4, 0.0


def robots(**changes):
    return {"robots": [RED.replace(**changes), BLUE]}


# -- what needs a new start --------------------------------------------------------------------


@each_case(
    ("changes", "words"),
    [
        ({"sampling_time": 0.2}, "Scenario.sampling_time is another one"),
        ({"neighbours": Within(1.0)}, "Scenario.neighbours is another one"),
        ({"joints": [Rope(a="red", b="blue")]}, "Scenario.joints is another one"),
        ({"robots": [RED, BLUE, Robot(pose=(0, 3, 0))]}, "3 robots in place of 2"),
        ({"props": [Puck(pose=(-2, 0, 0), name="crate")]}, "crate is a Puck now"),
        ({"props": [BOX.replace(length=0.7)]}, "length of crate is another one"),
        (robots(diameter=0.4), "diameter of red is another one"),
        (robots(drive=Holonomic()), "drive of red is another one"),
        (robots(drive=Unicycle(noise=0.1)), "drive of red has another noise"),
        (robots(sensors=[Proximity(range=1.0)]), "sensors of red is another one"),
        (robots(name="rot"), "name of rot|name of red"),
        ({"addons": [Communication()]}, "the add-on 'communication', which does something"),
        ({"addons": [Game({"hunter": ["red"], "prey": ["blue"]})]}, "the add-on 'game', which"),
    ],
)
def test_what_needs_a_new_start_is_refused_by_name_and_nothing_happens(changes, words):
    world = World(BEFORE)
    world.step()
    with pytest.raises(InputError, match=f"this needs a new start: .*({words})"):
        world.change(BEFORE.replace(**changes))
    assert world.scenario is BEFORE
    assert world.operator.log == []
    world.step()


def test_an_add_on_that_acts_may_stay_but_not_be_another_one():
    game = Game({"hunter": ["red"], "prey": ["blue"]})
    before = BEFORE.replace(addons=[game])
    world = World(before)
    world.change(before.replace(addons=[BLOCK, game]))
    assert world.addons.game.free == (1,)
    for addons in ([], [game.replace(capture=0.5)]):
        with pytest.raises(InputError, match="the add-on 'game', which does something"):
            world.change(world.scenario.replace(addons=addons))


# -- what may change -----------------------------------------------------------------------------


def test_walls_are_drawn_while_robots_drive_and_stop_them():
    before = Scenario(robots=[RED.replace(controller=forward), BLUE.replace(pose=(-3, 3, 0))])
    world = World(before)
    for _ in range(10):
        world.step()
    world.change(before.replace(addons=[Map([[(1.0, -1.0), (1.0, 1.0)]])]))
    assert world.pose[0, 0] == pytest.approx(0.4)
    assert world.obstacles == (((1.0, -1.0), (1.0, 1.0)),)
    assert world.surroundings.distance((0.5, 0.0), 3.0, ignore=0) == pytest.approx(0.5)
    for _ in range(30):
        world.step()
    assert world.pose[0, 0] == pytest.approx(0.85, abs=1e-3)
    world.change(before)
    for _ in range(5):
        world.step()
    assert world.pose[0, 0] > 1.0


def test_a_lighter_crate_is_pushed_faster_from_then_on_and_the_energy_is_accounted_for():
    drive = Unicycle(max_linear_speed=5.0, max_force=2.0, force_limited=True)
    red = Robot(name="red", controller=lambda robot: (5.0, 0.0), drive=drive)
    crate = Box(pose=(0.4, 0, 0), name="crate", mass=3.0, ground_friction=0.0)
    world = World(Scenario(robots=[red], props=[crate], workspace=None, stop_time=2.0))
    for _ in range(10):
        world.step()
    before = world.prop_velocity[0, 0]
    assert before == pytest.approx(2.0 / 4.0, abs=0.03), "a = F / (m + M)"
    world.change(world.scenario.replace(props=[crate.replace(mass=1.0)]))
    while not world.over:
        world.step()
    gained = world.prop_velocity[0, 0] - before
    assert gained == pytest.approx(2.0 / 2.0, abs=0.03), "a = F / (m + M)"
    record = world.record
    assert abs(record.energy.missing).max() < 1e-12
    lost = np.diff(record.energy.by("hands"))
    assert np.flatnonzero(lost).tolist() == [9]
    assert lost[9] == pytest.approx(-(3.0 - 1.0) / 2 * before**2, rel=1e-6)
    assert record.momentum.linear[9, 0, 1] == pytest.approx(3 * record.prop_velocity[9, 0, 0])
    assert record.momentum.linear[10, 0, 1] == pytest.approx(record.prop_velocity[10, 0, 0])
    assert rerun(record) is None


def test_a_stronger_drive_and_a_stiffer_spring_act_from_then_on():
    drive = Unicycle(max_force=1.0)
    red = Robot(name="red", controller=forward, drive=drive)
    anchor = Spring(a="red", b=None, stiffness=5.0, damping=4.0)
    world = World(Scenario(robots=[red], joints=[anchor]))

    def stretch():
        for _ in range(100):
            world.step()
        return world.pose[0, 0]

    assert stretch() == pytest.approx(1.0 / 5.0, abs=0.01), "F / k"
    world.change(world.scenario.replace(robots=[red.replace(drive=drive.replace(max_force=2.0))]))
    assert stretch() == pytest.approx(2.0 / 5.0, abs=0.01)
    world.change(world.scenario.replace(joints=[anchor.replace(stiffness=10.0)]))
    assert stretch() == pytest.approx(2.0 / 10.0, abs=0.01)
    assert rerun(world.record) is None


def test_a_slower_drive_brakes_a_robot_at_its_rate_while_the_noise_of_another_goes_on():
    quick = Unicycle(max_linear_speed=1.0, max_acceleration=0.5)
    noisy = BLUE.replace(drive=Unicycle(noise=0.1), controller=forward)
    before = Scenario(robots=[RED.replace(drive=quick, controller=lambda _: (1.0, 0.0)), noisy])
    one, other = World(before), World(before)
    for k in range(50):
        if k == 30:
            slow = before.robots[0].replace(drive=quick.replace(max_linear_speed=0.5))
            one.change(before.replace(robots=[slow, noisy]))
        one.step()
        other.step()
    assert one.velocity[0, 0] == pytest.approx(0.5)
    speeds = np.diff(one.history.pose[:, 0, 0]) / 0.1
    assert speeds[30] == pytest.approx(0.975), "it gets slower by 0.5 m/s^2, not at once"
    assert one.pose[:, 1] == pytest.approx(other.pose[:, 1], abs=1e-9)


def test_a_robot_in_motion_goes_on_as_if_nothing_had_happened():
    drive = Unicycle(max_acceleration=0.5)
    red = RED.replace(controller=lambda robot: (0.4, 0.7), drive=drive)
    before = Scenario(robots=[red, BLUE.at(-3, 3)], command_delay=0.25)
    one, other = World(before), World(before)
    for k in range(40):
        if k == 3:
            one.change(before.replace(title="Another title", animation=Animation()))
        one.step()
        other.step()
    assert np.array_equal(one.pose, other.pose)


@pytest.mark.parametrize(
    ("outline", "words"),
    [
        ([(-0.1, -0.1), (0.1, -0.1), (0.0, 0.1)], "red.*obstacle 0"),
        ([(-2.1, -0.1), (-1.9, -0.1), (-2.0, 0.1)], "crate.*obstacle 0"),
    ],
)
def test_a_wall_in_a_body_is_refused_and_nothing_happens(outline, words):
    world = World(BEFORE)
    far = [RED.at(0, 4), BLUE]
    drawn = BEFORE.replace(robots=far, props=[BOX.at(-2, 4)], addons=[Map([outline])])
    with pytest.raises(InputError, match=words):
        world.change(drawn)
    assert world.scenario is BEFORE
    world.step()


def test_so_it_is_where_a_joint_holds_something():
    ropes = {"joints": [Rope(a="red", b="blue", length=3.0)]}
    world = World(Scenario(robots=[RED, BLUE], **ropes))
    drawn = Map([[(-0.1, -0.1), (0.1, -0.1), (0.0, 0.1)]])
    after = Scenario(robots=[RED.at(0, 1), BLUE], addons=[drawn], **ropes)
    with pytest.raises(InputError, match="red would be in obstacle 0"):
        world.change(after)
    world.change(Scenario(robots=[RED.at(0, 1), BLUE], addons=[BLOCK], **ropes))
    assert world.pose[:, 0].tolist() == [0, 0, 0]


def test_where_robots_go_through_one_another_walls_can_be_drawn_all_the_same():
    both = [RED.replace(controller=forward), BLUE.replace(pose=(0.4, 0, 0))]
    before = Scenario(robots=both, physics="ideal")
    world = World(before)
    for _ in range(8):
        world.step()
    assert world.pose[0, 0] == pytest.approx(0.32)  # in the other
    world.change(before.replace(addons=[BLOCK]))
    world.step()


# -- laws ------------------------------------------------------------------------------------------


def test_a_robots_law_that_is_replaced_finds_the_memory_of_the_one_before():
    def counting(robot):
        robot.memory.count = getattr(robot.memory, "count", 0) + 1
        return 0.1, 0.0

    def reading(robot):
        return 0.0, 0.01 * robot.memory.count

    before = Scenario(robots=[RED.replace(controller=counting), BLUE])
    world = World(before)
    for _ in range(5):
        world.step()
    world.change(before.replace(robots=[RED.replace(controller=reading), BLUE]))
    world.step()
    assert world.command[:, 0].tolist() == [0.0, 0.05]


def test_a_law_that_stays_goes_on_where_its_generator_was():
    def counting(robot):
        for k in range(100):
            yield 0.001 * k, 0.0

    before = Scenario(robots=[RED.replace(controller=counting), BLUE])
    world = World(before)
    for _ in range(5):
        world.step()
    world.change(before.replace(addons=[BLOCK]))
    world.step()
    assert world.command[0, 0] == pytest.approx(0.005)


def test_the_law_of_the_team_goes_on_or_is_replaced():
    def counting(world):
        for k in range(100):
            yield [[0.001 * k, 0.0], [0.0, 0.0]]

    world = World(BEFORE, counting)
    for _ in range(3):
        world.step()
    world.change(BEFORE.replace(addons=[BLOCK]), world.control)
    world.step()
    assert world.command[0, 0] == pytest.approx(0.003)
    world.change(BEFORE, lambda world: [[0.2, 0.2], [0.0, 0.0]])
    world.step()
    assert world.command[0].tolist() == [0.2, 0.2]
    world.change(BEFORE, None)
    world.step()
    assert world.command[0].tolist() == [0.0, 0.0]
