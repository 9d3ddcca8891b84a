"""Records: row k is the world at k sampling times; what is saved comes back to the last bit."""

from __future__ import annotations

import json
from functools import cached_property

import numpy as np
import pytest

import mars2d
from mars2d import Holonomic, InputError, Record, Robot, Scenario, Sensor, World
from mars2d.addons import Map
from mars2d.bodies.joints import Hinge, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Gate, Prop, Puck, Solid
from mars2d.bodies.rigid import Inertia
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.record.contact import CONTACT
from mars2d.record.rows import COLUMNS
from mars2d.scenario import serialize
from mars2d.sensors import Proximity
from mars2d.world.verify import rerun
from tests.cases import each_case
from tests.worlds import ELL, without_laws


class Beams(Sensor):
    """Three readings that tell when and on whom they were taken."""

    def read(self, robot, world, rng):
        return np.array([world.time, robot.index, robot.pose[0]])


def law(robot):
    return 0.3, 0.1 * robot.index


def scenario(**fields) -> Scenario:
    robots = [
        Robot(sensors=[Proximity(range=0.4), Beams()], controller=law),
        Robot(pose=(1, 0, np.pi), drive=Holonomic()),
        Robot(pose=(0, 2, 0), sensors=[Beams()], controller=law, name="last"),
    ]
    props = [Puck(pose=(-0.5, 2)), Box(pose=(0.5, 2.0, 0.3), length=0.2, name="load")]
    defaults = {"addons": [Map([[(0.5, -1), (0.5, 1)]])], "stop_time": 2, "command_delay": 0.05,
                "props": props}  # fmt: skip
    return Scenario(robots=robots, **(defaults | fields))


@pytest.fixture
def record() -> Record:
    return mars2d.run(scenario(), seed=7)


# -- columns --------------------------------------------------------------------------------


def test_columns_have_time_first(record):
    shapes = {
        "time": (), "pose": (3, 3), "command": (2, 3), "command_time": (), "prop_pose": (3, 2),
        "effort": (3,), "velocity": (3, 3), "prop_velocity": (3, 2), "work": (6,),
    }  # fmt: skip
    assert {name: getattr(record, name).shape for name in shapes} == {
        name: (21, *shape) for name, shape in shapes.items()
    }
    assert record.sensors["proximity"].shape == (21, 1)
    assert record.sensors["beams"].shape == (21, 2, 3)
    assert record.sensor_robots == {"proximity": (0,), "beams": (0, 2)}
    assert record.contacts.dtype == CONTACT
    assert len(record) == 21


def test_row_k_is_the_world_at_k_sampling_times_up_to_the_stop_time(record):
    assert np.array_equal(record.time, np.arange(21) * 0.1)
    assert record.pose[0].tolist() == record.scenario.initial_pose.tolist()
    assert np.array_equal(record.sensors["beams"][:, 0, 0], record.time)
    assert np.array_equal(record.sensors["beams"][:, 0, 2], record.pose[:, 0, 0])
    assert record.sensors["beams"][:, :, 1].tolist() == [[0, 2]] * 21
    assert np.array_equal(record.command_time, record.time + 0.05)


def test_a_command_of_row_k_moves_the_robot_from_row_k_to_row_k_plus_1():
    speeds = [0.1, 0.3, -0.2, 0.0, 0.4]
    world = World(Scenario(robots=[Robot(drive=Holonomic())]))
    for speed in speeds:
        world.step([[speed], [0]])
    record = world.record
    assert record.command[:, 0, 0].tolist() == speeds
    assert np.diff(record.pose[:, 0, 0]) == pytest.approx(0.1 * np.array(speeds[:-1]))


def test_why_it_ended_is_kept(record):
    assert record.over_message == "finished after 2 s"
    assert record.finished
    assert record.seed == 7
    assert record.versions["mars2d"] == mars2d.__version__
    assert {"pymunk", "numpy", "python", "platform"} <= set(record.versions)


# -- digest ---------------------------------------------------------------------------------


def test_the_digest_depends_on_every_column(record):
    columns = {name: getattr(record, name) for name in COLUMNS}
    changes = [
        *({name: column + 1e-15} for name, column in columns.items()),
        {"over_message": "x"},
        {"sensors": {**record.sensors, "beams": record.sensors["beams"] + 1e-9}},
        {"sensors": {"proximity": record.sensors["proximity"]}},
        {"contacts": record.contacts[:-1]},
    ]
    digests = {record.digest, *(_with(record, **change).digest for change in changes)}
    assert len(digests) == 1 + len(changes) >= 14
    assert _with(record).digest == record.digest


def _with(record: Record, **changes) -> Record:
    others = ("scenario", "seed", "sensors", "sensor_robots", "contacts", "over_message")
    return Record(**({name: getattr(record, name) for name in (*COLUMNS, *others)} | changes))


# -- frames ---------------------------------------------------------------------------------


@each_case(("row", "same"), [(0, 0), (7, 7), (-1, 20), (-21, 0)])
def test_a_frame_is_what_was_seen_at_a_row(record, row, same):
    frame = record.frame(row)
    assert frame.iteration == same
    assert frame.time == record.time[same]
    assert np.array_equal(frame.pose, record.pose[same])
    assert np.array_equal(frame.path, record.pose[:same])
    robot, values = frame.readings["beams"][1]
    assert robot == 2
    assert np.array_equal(values, record.sensors["beams"][same, 1])
    assert bool(frame.over_message) is (same == 20)


def test_a_frame_has_the_contacts_of_the_control_step_that_led_to_its_row():
    live: list[np.ndarray] = []
    world = World(scenario(), watch=lambda world: live.append(world.frame.contacts.copy()))
    while not world.over:
        world.step()
    record = world.record
    assert sum(map(len, live)) == len(record.contacts) > 10
    for row, seen in enumerate(live):
        frame = record.frame(row)
        assert frame.contacts.tobytes() == seen.tobytes(), row
        times = frame.contacts["time"]
        assert (times > record.time[row] - 0.1 - 1e-9).all()
        assert (times + frame.contacts["duration"] <= record.time[row] + 1e-9).all()
        assert len(frame.contact_log()) == sum(map(len, live[: row + 1]))


@each_case("sampling_time", [0.01, 0.1, 0.3, 1 / 3, 1e-6])
def test_a_contact_at_the_very_end_of_a_control_step_belongs_to_it(sampling_time):
    robots = [Robot(), Robot(pose=(0.2999, 0, np.pi))]  # in touch from the start
    stop_time = 100 * sampling_time
    world = World(Scenario(robots=robots, sampling_time=sampling_time, stop_time=stop_time))
    for _ in range(30):
        world.step([[0.2, 0.2], [0, 0]])
    record = world.record
    assert [len(record.frame(row).contacts) for row in range(30)] == [0] + [1] * 29


# -- props, joints and shapes as plain data, and run again ----------------------------------------

ARROW = Polygon([(-0.15, -0.1), (0.2, 0), (-0.15, 0.1), (-0.1, 0)])


def pushes(robot):
    return 0.3, 0.2 * np.sin(robot.time + robot.index)


def workshop(**fields) -> Scenario:
    """One of everything: each kind of prop, joint and shape, and materials."""
    robots = [
        Robot(pose=(0, 0, 0), controller=pushes, friction="rubber"),
        Robot(pose=(0, 1, 0), controller=pushes, shape=ARROW, moment=0.02, center_offset=0.02),
        Robot(pose=(0, 2, 0), controller=pushes, drive=Holonomic(max_force=3), restitution="wood",
              shape=Compound([Disc(0.2), ARROW.moved(0.1, 0), Compound([Disc(0.1)])])),
    ]  # fmt: skip
    props = [
        Box(pose=(0.5, 0.1, 0.2), material="cardboard", height=0.2),
        Ball(pose=(0.6, 1.05), velocity=(0, 0.1, 1)),
        Puck(pose=(1.2, 1), friction="ice", mass=0.5),
        Bar(pose=(0.6, 2.1, 1.5), length=0.8, ground_friction=0.2, moment=0.06),
        Gate(pose=(1.5, 0, np.pi / 2), stiffness=1.0, limits=(-1, 1.5)),
        Solid(ELL, pose=(-1, 0, 0.5), name="ell", color="red"),
        Solid(Compound([Disc(0.3).moved(-0.2, 0), ELL.moved(0.1, 0)]), pose=(-1, 2)),
    ]
    joints = [
        Rope(a="robot0", b="ell", length=1.5),
        Rod(a="robot1", b="solid6", anchor_a=(-0.1, 0)),
        Spring(a="ball1", b="puck2", stiffness=5, damping=0.1),
        Hinge(a="bar3", anchor_b=(0.6, 2.1), limits=(-1, 1), stiffness=0.5, damping=0.1),
    ]
    everything = {"robots": robots, "props": props, "joints": joints, "stop_time": 3}
    return Scenario(**(everything | fields))


def in_json(scenario: Scenario) -> tuple[Scenario, tuple[str, ...]]:
    return serialize.to_scenario(json.loads(json.dumps(serialize.from_description(scenario))))


@each_case("physics", ["contact", "stop", "ideal"])
def test_props_joints_shapes_and_materials_come_back_from_a_file(physics):
    scenario = workshop(physics=physics)
    again, missing = in_json(scenario)
    assert missing == ()
    assert again == without_laws(scenario)
    assert again.bodies == scenario.bodies
    assert [tie._replace(joint=None) for tie in again.ties] == [
        tie._replace(joint=None) for tie in scenario.ties
    ]


@each_case("physics", ["contact", "stop", "ideal"])
def test_a_record_with_props_and_joints_runs_again_to_the_last_bit(physics, tmp_path):
    record = mars2d.run(workshop(physics=physics), seed=3)
    assert not np.array_equal(record.prop_pose[0], record.prop_pose[-1])
    assert len(record.contacts) > 5
    again = mars2d.load(record.save(tmp_path / "run.npz"))
    assert again.digest == record.digest
    assert rerun(again) is None


class Trolley(Prop):
    """A prop of the user's own: two discs on a plank, heavier than it looks, and slippery."""

    gap: float = 0.2
    friction = 0.1

    @cached_property
    def shape(self):
        ends = [Disc(0.1).moved(side * self.gap, 0) for side in (-1, 1)]
        return Compound([*ends, Bar(length=2 * self.gap, thickness=0.04).shape])

    @property
    def inertia(self):
        return Inertia(2.0, 0.05)


class Trap(Prop):
    """A prop of the user's own that brings a joint."""

    @cached_property
    def shape(self):
        return Disc(0.2)

    def joints(self):
        return (Rope(a=self.name, anchor_b=self.pose[:2], length=0.5),)


class Tow(Rope):
    """A joint of the user's own."""

    length: float | None = 0.9


def test_for_a_prop_of_the_users_own_a_solid_stands_in_that_moves_alike(tmp_path):
    robot = Robot(controller=lambda robot: (0.3, 0.1))
    trolley = Trolley(pose=(0.5, 0.05, 1.0), velocity=(0, 0.2, 0), name="trolley")
    record = mars2d.run(Scenario(robots=[robot], props=[trolley], stop_time=3))
    assert len(record.contacts) > 5
    again = mars2d.load(record.save(tmp_path / "run.npz"))
    assert again.missing == ("prop Trolley",)
    stand_in = again.scenario.props[0]
    assert type(stand_in) is Solid
    assert (stand_in.shape, stand_in.inertia) == (trolley.shape, trolley.inertia)
    assert (stand_in.name, stand_in.pose, stand_in.surface) == (
        "trolley", trolley.pose, trolley.surface,
    )  # fmt: skip
    assert rerun(again) is None


@each_case(
    ("fields", "missing"),
    [
        ({"props": [Trap(pose=(1, 0))]}, ("prop Trap", "joint Rope of Trap")),
        ({"props": [Box(pose=(0.8, 0))], "joints": [Tow(a="robot0", b="box0")]}, ("joint Tow",)),
    ],
)
def test_without_joints_or_shapes_of_the_users_own_a_record_is_not_run_again(
    fields, missing, tmp_path
):
    record = mars2d.run(Scenario(stop_time=0.5, **fields))
    again = mars2d.load(record.save(tmp_path / "run.npz"))
    assert again.missing == missing
    assert again.digest == record.digest
    named = [part for part in missing if not part.startswith("prop")]
    with pytest.raises(InputError, match=f"does not hold the {', '.join(named)}"):
        rerun(again)
