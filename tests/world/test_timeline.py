"""The timeline: going back and on is the same to the bit, whatever laws remember."""

from typing import ClassVar

import numpy as np
import pytest

import mars2d
from mars2d import LawError, Robot, Scenario
from mars2d.addons import Communication, Map
from mars2d.addons.base import Addon
from mars2d.bodies.props import Box
from mars2d.core.errors import InputError
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.world.branch import MOST
from mars2d.world.loop import simulate
from mars2d.world.timeline import Timeline
from mars2d.world.verify import rerun
from tests.cases import each_case

WALL = Map([[(1.0, 2.0), (2.0, 2.0)]], name="drawn")


def finish(timeline):
    while not timeline.over:
        timeline.advance()


def branch(timeline, progress=lambda _: True):
    """Go on from the present row, and do nothing there; return the world."""
    timeline.change(lambda _: None, progress)
    return timeline.world


def run_to(timeline, row):
    while timeline.newest < row:
        timeline.advance()


@pytest.fixture
def written(tmp_path):
    """Write an experiment's file, and others beside it; return its path."""

    def write(text, **others):
        for name, content in {"walk": text, **others}.items():
            (tmp_path / f"{name}.py").write_text(content)
        return tmp_path / "walk.py"

    return write


def simulated(path, seed=3):
    return simulate(open_experiment(path, seed=seed)).record


# -- every example ---------------------------------------------------------------------------------


QUICK = {"own_sensor_and_addon", "wall_slide"}


@pytest.mark.parametrize(
    "name",
    [
        name if name in QUICK else pytest.param(name, marks=[pytest.mark.slow, pytest.mark.nightly])
        for name in examples()
    ],
)
def test_an_example_gone_back_in_is_the_same_to_the_bit(name):
    options = {"stop_time": 4.0} if name == "flocking" else {}
    expected = simulate(open_experiment(name, options, seed=1)).record
    timeline = Timeline(open_experiment(name, options, seed=1))
    timeline.go(0)
    finish(timeline)
    assert timeline.record.digest == expected.digest
    last = timeline.newest
    for row in (last // 2, last // 3, 2 * last // 3, 0, last - 1):
        timeline.go(row)
        world = branch(timeline)
        assert timeline.branch.doubt == ""
        assert world.iteration == row
        assert np.array_equal(world.pose, expected.pose[row])
        finish(timeline)
        record = timeline.record
        assert record.digest == expected.digest
        assert len(record.branches) == len(timeline.branches)
    assert all(branch.digest == expected.digest for branch in record.branches)


# -- what laws remember ----------------------------------------------------------------------------

HELPER = "class Count:\n    n = 0\n"

MEMORY = '''
"""Laws that remember in every way that there is."""
from helper import Count
from mars2d import Robot, Scenario, Unicycle, load_law
from mars2d.addons import Communication
from mars2d.sensors import RangeFinder

calls = []

def nearest(robot):
    return min(3.0, *robot.sense.range_finder)

def by_generator(robot):
    turn = 0.0
    while True:
        turn += 0.1 * robot.rng.standard_normal()
        yield 0.3, turn

def by_memory(robot):
    robot.memory.k = getattr(robot.memory, "k", 0) + 1
    if robot.time % 1 < 0.05:
        robot.send(robot.memory.k)
    return 0.2, 0.1 * len(robot.inbox) + 0.01 * robot.memory.k + nearest(robot) / 9

def by_module(robot):
    calls.append(robot.time)
    Count.n += 1
    return 0.2, 0.01 * len(calls) - 0.02 * Count.n

def by_object():
    count = 0
    def law(robot):
        nonlocal count
        count += 1
        return 0.25, 1.0 if count % 7 < 3 else -1.0
    return law

drive = Unicycle(max_linear_speed=1.0, noise=0.1, dead_time=0.1, max_acceleration=0.5)
sensors = [RangeFinder(beams=5, range=3.0, noise=0.05, latency=0.15, rate=10)]
laws = [by_generator, by_memory, by_module, by_object(), load_law("law.py"), load_law("law.py")]
scenario = Scenario(
    robots=[
        Robot(drive=drive, sensors=sensors, controller=law).at(0.9 * i - 2.5, 0.3 * i, i)
        for i, law in enumerate(laws)
    ],
    addons=[Communication(loss=0.3, delay=0.2, range=3.0)],
    sampling_time=0.05, stop_time=10, command_delay=0.02,
)
'''

LAW = """
from math import sin
seen = []
def control(robot):
    seen.append(min(3.0, robot.sense.range_finder[0]))
    return 0.2, sin(sum(seen[-5:])) + 0.01 * len(seen)
"""


@pytest.fixture
def memory(written):
    return written(MEMORY, helper=HELPER, law=LAW)


def test_memory_of_every_kind_is_rebuilt(memory):
    expected = simulated(memory)
    timeline = Timeline(open_experiment(memory, seed=3))
    finish(timeline)
    for row in (100, 199, 0):
        timeline.go(row)
        branch(timeline)
        assert timeline.branch.doubt == ""
        finish(timeline)
        assert timeline.record.digest == expected.digest


class Noting(Addon):
    """Notes at which steps it is called, in a list that all copies share."""

    steps: ClassVar[list[int]] = []

    def on_step(self, world):
        self.steps.append(world.iteration)


def straight(robot):
    robot.memory.k = getattr(robot.memory, "k", 0) + 1
    return 0.2, 0.01 * robot.memory.k + robot.rng.normal()


def test_a_world_goes_on_from_the_last_snapshot_and_repeats_only_what_follows():
    robots = [Robot(controller=straight).at(0, y) for y in (0.0, 0.4)]
    boxes = [Box(length=0.4, width=0.4, pose=(0.45, 0.1, 0))]
    talk = Communication(loss=0.3, delay=0.2)
    team = Scenario(robots=robots, props=boxes, addons=[Noting(), talk], stop_time=100)
    expected = simulate(Experiment(team, seed=3)).record
    timeline = Timeline(Experiment(team, seed=3))
    run_to(timeline, 90)
    timeline.world.operator.place(0, (3, 3, 0))
    finish(timeline)
    for row in (90, 70):  # before and after the robot was put elsewhere
        timeline.go(row)
        Noting.steps.clear()
        branch(timeline)
        assert Noting.steps == [*range(64, row + 1)]
        assert timeline.branch.doubt == ""
    finish(timeline)
    assert timeline.record.digest == expected.digest
    assert len(timeline.branch.snapshots) <= MOST
    timeline.go(300)
    Noting.steps.clear()
    assert timeline.set({"robots.robot0.mass": 2.0}) == ""
    assert Noting.steps[0] == 256, "a slider whose laws are the same needs no new start either"
    assert timeline.world.scenario.robots[0].mass == 2.0
    assert timeline.branch.snapshots
    timeline.restart()
    assert len(timeline.others) == 4
    assert not any(each.snapshots for each in timeline.others), "which take memory"


# -- hands -----------------------------------------------------------------------------------------


def poke(timeline, upto=150):
    """Put, pull, drive, draw and let go, and run on."""
    while timeline.newest < upto:
        world, k = timeline.world, timeline.newest
        if k == 20:
            world.operator.place(1, (3.0, 3.0, 1.0))
        if k == 30:
            world.change(
                world.scenario.replace(addons=[*world.scenario.addons, WALL]), world.control
            )
        if 40 <= k < 50:
            world.operator.pull(0, (0.1, 0.0), (2.0 + 0.1 * k, 1.0), 30.0)
        if k == 50:
            world.operator.pull(0, (0.1, 0.0), None)
        if k == 60:
            world.operator.steer(2, (0.2, 1.0))
        if k == 90:
            world.operator.steer(2, None)
        if k == 100:  # it acts still when time goes on from row 120
            world.operator.push(1, (3.0, 4.0), 30.3 * world.sampling_time, (0.1, 0.0))
        timeline.advance()


@pytest.mark.slow
@each_case("row", [20, 25, 45, 70, 120])
def test_what_hands_did_is_done_again(memory, row):
    timeline = Timeline(open_experiment(memory, seed=3))
    poke(timeline)
    before = timeline.world.record
    timeline.go(row)
    shown = timeline.frame.pose
    branch(timeline)
    assert timeline.branch.doubt == ""
    assert np.array_equal(timeline.world.pose, shown)
    assert np.array_equal(timeline.world.history.pose, before.pose[:row])
    assert timeline.world.scenario.addons == before.scenario_at(row).addons
    if row > 50 and row != 70:  # where hands are off, all goes on as it did
        run_to(timeline, 150)
        again = timeline.world.record
        assert np.array_equal(again.pose, before.pose)
        assert np.array_equal(again.command, before.command)
        assert again.sensors.keys() == before.sensors.keys()
        for name, values in before.sensors.items():
            assert np.array_equal(again.sensors[name], values)
        assert np.array_equal(again.messages["status"], before.messages["status"])


def test_what_hands_did_is_undone_and_the_run_with_it_is_a_branch(written):
    experiment = open_experiment(written(UNDONE))
    timeline = Timeline(experiment)
    for _ in range(10):
        timeline.advance()
    untouched = timeline.world.pose.copy()
    timeline.change(lambda world: world.operator.place("crate", (2, 2, 0)))
    timeline.change(lambda world: world.operator.steer("red", (0.5, 0)))
    for _ in range(3):
        timeline.advance()
        timeline.change(lambda world: world.operator.steer("red", (0.5, 0.1 * world.iteration)))
    steered = timeline.undo()  # the whole drive
    assert (steered.row, timeline.row, timeline.newest) == (10, 10, 10)
    assert timeline.world.prop_pose[:2, 0].tolist() == [2, 2]
    assert [branch.world.iteration for branch in timeline.branches] == [13]
    timeline.undo()
    assert timeline.world.prop_pose[:2, 0].tolist() == [0, 0]
    assert np.array_equal(timeline.world.pose, untouched)
    while not timeline.world.over:
        timeline.advance()
    assert timeline.world.record.digest == simulate(experiment.reopened()).record.digest
    with pytest.raises(InputError, match="nothing was done by hand"):
        timeline.undo()


UNDONE = """
from mars2d import Robot, Scenario
from mars2d.bodies.props import Box

def ahead(robot):
    return 0.1, 0.3

scenario = Scenario(
    robots=[Robot(name="red", pose=(-2, 0, 0), controller=ahead)],
    props=[Box(name="crate", length=0.4, width=0.4)], stop_time=2.0, sampling_time=0.1,
)
"""


# -- branches --------------------------------------------------------------------------------------


def test_a_branch_of_a_branch_and_back(memory):
    expected = simulated(memory)
    timeline = Timeline(open_experiment(memory, seed=3))
    finish(timeline)
    timeline.go(80)
    timeline.change(lambda w: w.operator.place(0, (-4.0, -4.0, 0.0)))
    run_to(timeline, 150)
    timeline.go(120)
    timeline.change(lambda w: w.operator.place(1, (4.0, -4.0, 0.0)))
    run_to(timeline, 140)
    second, first = timeline.world, timeline.branches[1]
    assert timeline.branch.common(first) == 120
    assert timeline.branch.common(timeline.branches[0]) == 80
    timeline.show(timeline.others[0])
    assert timeline.record.digest == expected.digest
    assert timeline.row == 140
    timeline.show(timeline.others[0])
    assert timeline.world is first.world
    timeline.go(100)
    timeline.show(timeline.others[0])
    assert timeline.world is second
    assert timeline.row == 100
    timeline.go(130)
    branch(timeline)
    assert np.array_equal(timeline.world.pose, second.history.pose[130])
    assert timeline.branch.doubt == ""


def test_a_world_at_its_start_and_one_that_is_over_can_be_changed(written):
    path = written("""
from mars2d import Robot, Scenario
def law(robot):
    if robot.position[0] > 1:
        robot.world.stop("there")
    return 1.0, 0.0
scenario = Scenario(robots=[Robot(controller=law)], stop_time=50, sampling_time=0.1)
""")
    timeline = Timeline(open_experiment(path))
    assert branch(timeline) is timeline.world  # at row 0, the newest
    finish(timeline)
    assert timeline.frame.over_message == "there"
    last = timeline.newest
    timeline.change(lambda w: w.operator.place(0, (-1.0, 0.0, 0.0)))
    assert not timeline.over
    assert [branch.world.over_message for branch in timeline.branches] == ["there"]
    finish(timeline)
    assert timeline.newest > last + 10
    timeline.go(0)
    timeline.change(lambda w: w.operator.place(0, (-2.0, 0.0, 0.0)))
    finish(timeline)
    assert timeline.frame.over_message == "there"
    assert len(timeline.branches) == 2


# -- errors ----------------------------------------------------------------------------------------

FAILING = """
from mars2d import Robot, Scenario
def law(robot):
    if robot.time > 1:
        return 1 / 0, 0
    return 0.2, 0.1
scenario = Scenario(robots=[Robot(controller=law)], sampling_time=0.1)
"""


def test_the_past_of_a_failed_run_can_be_looked_at_and_mended(written):
    path = written(FAILING)
    timeline = Timeline(open_experiment(path))
    with pytest.raises(LawError, match="division by zero") as raised:
        finish(timeline)
    failed = timeline.newest
    assert timeline.over
    assert timeline.error is raised.value
    timeline.go(5)
    assert timeline.frame.over_message == ""
    timeline.go(failed)
    path.write_text(FAILING.replace("1 / 0", "0.3"))
    timeline.change(lambda w: w.operator.steer(0, None))
    assert timeline.row == failed
    assert timeline.error is None
    assert timeline.branches == []  # the one that failed has no row that this one has not
    run_to(timeline, 2 * failed)
    assert timeline.world.history.command[-1].ravel().tolist() == [0.3, 0.0]


def test_a_file_that_is_broken_in_between_is_told_of_and_nothing_is_lost(written):
    path = written(FAILING)
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 8)
    path.write_text("scenario = Scen(")
    world = timeline.world
    timeline.go(4)
    with pytest.raises(InputError, match=r"walk\.py, line 1"):
        branch(timeline)
    with pytest.raises(InputError, match=r"walk\.py, line 1"):
        timeline.restart()
    assert (timeline.world, timeline.row, timeline.newest) == (world, 4, 8)
    path.write_text(FAILING)
    assert branch(timeline).iteration == 4


@each_case(
    "source",
    ["random.uniform(-1, 1)", "np.random.normal()", "time.perf_counter() % 1", "next(count)"],
)
def test_laws_that_depend_on_something_outside_are_told_of(written, source):
    path = written(f"""
import itertools, random, time
import numpy as np
from mars2d import Robot, Scenario
count = np.__dict__.setdefault("_counter_of_a_test", itertools.count())
scenario = Scenario(robots=[Robot(name="red", controller=lambda robot: (0.1, {source}))])
""")
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 50)
    poses = timeline.world.history.pose.copy()
    timeline.go(40)
    branch(timeline)
    assert "the law of red gave another command at step 0" in timeline.branch.doubt
    assert np.array_equal(timeline.world.history.pose, poses[:40])
    assert len(timeline.branches) == 1


# -- what laws do outside --------------------------------------------------------------------------


def test_prints_are_not_repeated(written, capsys):
    path = written("""
import sys
from mars2d import Robot, Scenario
print("read")
def law(robot):
    print("at", robot.time)
    print("warned", file=sys.stderr)
    return 0.1, 0.0
scenario = Scenario(robots=[Robot(controller=law)], sampling_time=1)
""")
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 5)
    timeline.go(3)
    branch(timeline)
    out, err = capsys.readouterr()
    assert out.splitlines() == ["read", *(f"at {k}.0" for k in range(5))]
    assert err.split() == 5 * ["warned"]
    timeline.advance()
    assert capsys.readouterr().out == "at 3.0\n"


def test_a_way_back_can_be_broken_off(memory, monkeypatch):
    timeline = Timeline(open_experiment(memory, seed=3))
    run_to(timeline, 190)
    timeline.go(180)
    told = []

    def progress(share):
        told.append(share)
        return len(told) < 2

    with monkeypatch.context() as patch, pytest.raises(InputError, match="nothing was changed"):
        patch.setattr("mars2d.world.branch.SLICE", 0.001)
        branch(timeline, progress)
    assert len(told) == 2
    assert 0 <= told[0] <= told[1] < 1
    assert (timeline.newest, timeline.branches) == (190, [])
    branch(timeline)
    assert timeline.newest == 180


# -- the experiment read again ---------------------------------------------------------------------

STRAIGHT = """
from mars2d import Robot, Scenario
from mars2d.addons import Map
from mars2d.sensors import Proximity
def law(robot):
    return 0.2, 0.0
scenario = Scenario(
    robots=[Robot(sensors=[Proximity(range=1)], controller=law).at(0, 0)],
    addons=[Map([[(4, -1), (4, 1)]])],
    sampling_time=0.1,
)
"""


def test_laws_read_again_are_in_effect_from_the_present_row(written):
    path = written(STRAIGHT)
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 20)
    path.write_text(STRAIGHT.replace("0.2, 0.0", "0.1, 0.5"))
    assert timeline.take(open_experiment(path)).startswith("in effect from now on")
    assert (timeline.row, timeline.newest, timeline.branches) == (20, 20, [])
    run_to(timeline, 30)
    command = timeline.world.history.command[:, :, 0]
    assert (command[:20] == (0.2, 0.0)).all()
    assert (command[20:] == (0.1, 0.5)).all()
    timeline.go(25)
    branch(timeline)
    assert timeline.branch.doubt == ""
    run_to(timeline, 30)
    assert np.array_equal(timeline.world.history.command[:, :, 0], command)


def test_in_the_past_they_make_a_branch(written):
    path = written(STRAIGHT)
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 20)
    timeline.go(10)
    path.write_text(STRAIGHT.replace("0.2, 0.0", "0.1, 0.5"))
    timeline.take(open_experiment(path))
    assert (timeline.newest, len(timeline.branches)) == (10, 1)
    run_to(timeline, 15)
    timeline.show(timeline.others[0])
    assert timeline.newest == 20
    timeline.go(timeline.newest)
    timeline.advance()
    assert timeline.world.history.command[-1].ravel().tolist() == [0.2, 0.0]  # of its own law
    timeline.go(5)
    branch(timeline)
    assert timeline.branch.doubt == ""  # no wonder that the new law asks for something else
    timeline.advance()
    assert timeline.world.history.command[-1].ravel().tolist() == [0.1, 0.5]


def test_what_is_read_at_the_end_holds_where_something_is_changed(written):
    text = STRAIGHT.replace("sampling_time=0.1,", "sampling_time=0.1, stop_time=2.0,")
    path = written(text)
    timeline = Timeline(open_experiment(path))
    finish(timeline)
    path.write_text(text.replace("0.2, 0.0", "0.1, 0.5").replace("(4, -1)", "(4, -2)"))
    assert timeline.take(open_experiment(path)).startswith("in effect where you go back")
    assert timeline.over
    timeline.go(10)
    branch(timeline)
    assert timeline.scenario.obstacles == (((4.0, -2.0), (4.0, 1.0)),)
    timeline.advance()
    assert timeline.world.history.command[-1].ravel().tolist() == [0.1, 0.5]
    assert timeline.branch.doubt == ""


def test_laws_read_again_have_watched_what_was_before(written):
    counting = """
from mars2d import Robot, Scenario
def law(robot):
    k = 0
    while True:
        k += 1
        yield 0.1, {0} * k
scenario = Scenario(robots=[Robot(controller=law)], sampling_time=0.1)
"""
    path = written(counting.format("0.01"))
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 20)
    path.write_text(counting.format("0.02"))
    timeline.take(open_experiment(path))
    timeline.advance()
    assert timeline.world.history.command[-1, 1, 0] == pytest.approx(0.02 * 21)


def test_walls_that_were_read_again_stand_from_now_on_and_drawn_ones_stay(written):
    path = written(STRAIGHT)
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 5)
    world = timeline.world
    world.change(world.scenario.replace(addons=[*world.scenario.addons, WALL]), world.control)
    run_to(timeline, 10)
    path.write_text(STRAIGHT.replace("0.2, 0.0", "0.1, 0.5"))
    timeline.take(open_experiment(path))
    assert [addon.key for addon in timeline.scenario.addons] == ["map", "drawn"]
    path.write_text(STRAIGHT.replace("(4, -1)", "(4, -2)"))
    timeline.take(open_experiment(path))
    assert timeline.scenario.obstacles == (((4.0, -2.0), (4.0, 1.0)),)
    run_to(timeline, 15)
    timeline.go(7)
    assert timeline.scenario.obstacles[0][0] == (4.0, -1.0)
    branch(timeline)
    assert timeline.world.scenario.obstacles[0][0] == (4.0, -1.0)
    assert len(timeline.world.scenario.obstacles) == 2


@each_case(
    ("old", "new", "words"),
    [
        ("Proximity(range=1)", "Proximity(range=2)", "sensors of robot0"),
        ("sampling_time=0.1", "sampling_time=0.2", "sampling_time"),
        ("[Robot(", "[Robot().at(3, 3), Robot(", "2 robots"),
        ("Robot(sensors", "Robot(diameter=0.7, sensors", "robot0"),
    ],
)
def test_what_needs_a_new_start_starts_again_and_says_why(written, old, new, words):
    path = written(STRAIGHT)
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 10)
    path.write_text(STRAIGHT.replace(old, new))
    assert words in timeline.take(open_experiment(path)).removeprefix("started again: ")
    assert (timeline.row, timeline.newest) == (0, 0)


def test_the_record_of_a_window_run_is_run_again_to_the_bit(memory, tmp_path):
    timeline = Timeline(open_experiment(memory, seed=3))
    poke(timeline)
    timeline.go(100)
    timeline.change(lambda w: w.operator.place(0, (-4.0, -4.0, 0.0)))
    run_to(timeline, 180)
    record = timeline.record
    assert rerun(record) is None
    assert [rerun(branch) for branch in record.branches] == [None]
    assert record.over_message == record.branches[0].over_message == "The window was closed"
    assert record.steps == timeline.frame.iteration, "as the window says"
    assert mars2d.run("push_box", stop_time=0.4).steps == 4, "of one that has come to its end"
    loaded = mars2d.load(record.save(tmp_path / "run.npz"))
    assert rerun(loaded) is None
    assert loaded.branches == ()


# -- started again --------------------------------------------------------------------------------


def test_a_run_that_hands_changed_is_kept_when_it_is_started_anew(memory):
    timeline = Timeline(open_experiment(memory, seed=3))
    run_to(timeline, 60)
    timeline.go(40)
    timeline.change(lambda w: w.operator.place(0, (-4.0, -4.0, 0.0)))
    run_to(timeline, 80)
    changed, (before,) = timeline.world, timeline.branches
    timeline.restart()
    assert (timeline.newest, timeline.branches) == (0, [])
    assert [branch.world for branch in timeline.others] == [changed, before.world]
    assert not timeline.touched
    assert timeline.changed
    finish(timeline)
    assert timeline.record.digest == simulated(memory).digest
    assert [len(branch) for branch in timeline.record.branches] == [80, 60]
    again = timeline.world
    timeline.go(5)
    timeline.show(timeline.others[0])
    assert (timeline.world, timeline.branches, timeline.row) == (changed, [before], 80)
    shown = [changed]
    for _ in range(3):
        timeline.show(timeline.others[0])
        shown.append(timeline.world)
    assert shown == [changed, before.world, again, changed], "each in turn"
    run_to(timeline, 90)
    timeline.go(50)
    assert branch(timeline) is not changed
    assert len(timeline.branches) == 2


def test_an_earlier_run_takes_the_laws_of_now_without_a_doubt(written):
    path = written(STRAIGHT)
    timeline = Timeline(open_experiment(path))
    run_to(timeline, 20)
    timeline.world.operator.place(0, (-1, 0, 0))
    path.write_text(STRAIGHT.replace("0.2, 0.0", "0.1, 0.5"))
    timeline.restart()
    timeline.show(timeline.others[0])
    timeline.go(10)
    branch(timeline)
    assert timeline.branch.doubt == ""
    timeline.advance()
    assert timeline.world.history.command[-1].ravel().tolist() == [0.1, 0.5]
