"""Messages to ROS have the fields and types of its definitions, as another library reads them."""

import dataclasses
import sys
import time
from types import SimpleNamespace

import numpy as np
import pytest

from mars2d import Car, InputError, Robot, Scenario, World
from mars2d.cli import command_line as cli
from mars2d.sensors import RangeFinder
from mars2d.world.ros import messages
from mars2d.world.ros.bridge import Bridge, check_drives

rosbags = pytest.importorskip("rosbags.typesys")


@pytest.fixture(scope="module")
def store():
    """The message definitions of ROS 2, and a reader and writer of its bytes."""
    return rosbags.get_typestore(rosbags.Stores.ROS2_HUMBLE)


def received(store, kind, tree):
    """Send a message, and return what is read; each field must be there, and no other."""

    def made(name, held):
        fields = store.fielddefs[name][1]
        assert {*held} == {field for field, _ in fields}, name
        values = {}
        for field, (kind, what) in fields:
            value = held[field]
            if kind == rosbags.base.Nodetype.NAME:
                values[field] = made(what, value)
            elif kind == rosbags.base.Nodetype.BASE:
                values[field] = value
            else:
                values[field] = np.array(value, dtype=what[0][1][0])
        return store.types[name](**values)

    return store.deserialize_cdr(store.serialize_cdr(made(kind, tree), kind), kind)


def test_times_and_frames(store):
    clock = received(store, "rosgraph_msgs/msg/Clock", messages.clock(12.25))
    assert (clock.clock.sec, clock.clock.nanosec) == (12, 250_000_000)
    assert messages.clock(0.9999999999)["clock"] == {"sec": 1, "nanosec": 0}
    tree = messages.transform(0.1, "odom", "red", (1.0, 2.0, np.pi / 2))
    found = received(store, "geometry_msgs/msg/TransformStamped", tree)
    assert (found.header.frame_id, found.child_frame_id) == ("odom", "red")
    assert (found.transform.translation.x, found.transform.translation.y) == (1.0, 2.0)
    turn = found.transform.rotation
    assert 2 * np.arctan2(turn.z, turn.w) == pytest.approx(np.pi / 2)
    assert turn.x**2 + turn.y**2 + turn.z**2 + turn.w**2 == pytest.approx(1)


def test_odometry_has_the_twist_in_the_robots_frame(store):
    world = World(Scenario(robots=[Robot(name="red", pose=(1, 2, 0.7))]))
    world.step([[0.3], [0.5]])
    pose, velocity = world.pose[:, 0].tolist(), world.velocity[:, 0].tolist()
    tree = messages.odometry(world.time, "red", pose, velocity)
    found = received(store, "nav_msgs/msg/Odometry", tree)
    assert (found.header.frame_id, found.child_frame_id) == ("odom", "red")
    assert found.pose.pose.position.x == world.pose[0, 0]
    twist = found.twist.twist
    assert (twist.linear.x, twist.angular.z) == pytest.approx((0.3, 0.5), abs=1e-6)
    assert abs(twist.linear.y) < 0.02  # the velocity is that at the end of the step
    assert len(found.pose.covariance) == len(found.twist.covariance) == 36


def test_a_scan_has_its_angles_and_ranges(store):
    finder = RangeFinder(beams=5, range=3.0, name="eye", field_of_view=2.0)
    world = World(Scenario(robots=[Robot(name="red", sensors=[finder])], on_exit="wall"))
    world.observe()
    reading = world.robots[0].sense.eye
    tree = messages.scan(0.0, "red/eye", finder.fan, reading, 0.1)
    found = received(store, "sensor_msgs/msg/LaserScan", tree)
    assert found.angle_min + 4 * found.angle_increment == pytest.approx(found.angle_max)
    assert (found.angle_min, found.angle_max) == pytest.approx((-1.0, 1.0))
    assert found.ranges == pytest.approx(np.asarray(reading))
    assert found.range_max == 3.0


def test_a_message_is_filled_to_its_leaves():
    @dataclasses.dataclass
    class Stamp:
        sec: int = 0
        nanosec: int = 0

    @dataclasses.dataclass
    class Clock:
        clock: Stamp = dataclasses.field(default_factory=Stamp)

    assert messages.fill(Clock(), messages.clock(2.5)) == Clock(Stamp(2, 500_000_000))


def test_without_ros_one_line_says_what_to_install(capsys):
    try:
        import rclpy  # noqa: F401
    except ImportError:
        assert cli.main(["ros", "random_walk"]) == cli.BAD_INPUT
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        assert "needs ROS 2 with its Python library rclpy" in said
        assert "source /opt/ros/" in said
    assert cli.main(["ros", "random_walk", "--speed", "0"]) == cli.BAD_INPUT


class Message:
    """A message of any kind: a field that is read first is a message, too."""

    def __init__(self, **fields):
        vars(self).update(fields)

    def __getattr__(self, name):
        return vars(self).setdefault(name, Message())


class Node:
    """Stands for a node of rclpy: keeps what is published, and how commands are taken."""

    def __init__(self):
        self.published, self.takers = {}, {}

    def create_publisher(self, kind, topic, depth):
        return SimpleNamespace(publish=self.published.setdefault(topic, []).append)

    def create_subscription(self, kind, topic, taker, depth):
        self.takers[topic] = taker

    def destroy_node(self):
        self.published["/gone"] = []


@pytest.fixture
def node(monkeypatch):
    """The node of a stand-in for rclpy, which can't be installed from a package index."""
    node = Node()
    command = Message(twist=Message(linear=Message(x=0.2), angular=Message(z=0.0)))
    rclpy = SimpleNamespace(
        init=lambda: None, create_node=lambda name: node, ok=lambda: True,
        spin_once=lambda node, timeout_sec: node.takers["/red/cmd_vel"](command),
        try_shutdown=lambda: None,
    )  # fmt: skip
    monkeypatch.setitem(sys.modules, "rclpy", rclpy)
    kinds = "Clock", "TFMessage", "TransformStamped", "TwistStamped", "Odometry", "LaserScan"
    every = SimpleNamespace(**dict.fromkeys(kinds, Message))
    for package in ("rosgraph_msgs", "tf2_msgs", "geometry_msgs", "nav_msgs", "sensor_msgs"):
        monkeypatch.setitem(sys.modules, f"{package}.msg", every)
    return node


def test_a_bridge_publishes_at_the_pace_of_its_speed_and_follows_commands(node):
    world = World(Scenario(robots=[Robot(name="red", pose=(0, 0, 0))], stop_time=2.0))
    began = time.monotonic()
    Bridge(world, speed=5.0).run()
    assert 0.39 < time.monotonic() - began < 2.0
    assert world.finished
    clocks = [m.clock.sec + 1e-9 * m.clock.nanosec for m in node.published["/clock"]]
    assert clocks == pytest.approx(np.arange(len(clocks)) * 0.1)
    assert len(node.published["/red/odom"]) == len(node.published["/tf"]) == len(clocks) == 21
    assert world.pose[0, 0] == pytest.approx(0.4, abs=0.03)
    assert "/gone" in node.published


def test_a_drive_that_takes_no_twist_is_named():
    with pytest.raises(InputError, match="red: cmd_vel is a twist, and its Car takes v and delta"):
        check_drives(Scenario(robots=[Robot(name="red", drive=Car())]))
