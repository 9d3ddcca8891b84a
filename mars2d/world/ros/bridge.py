"""The bridge between a world and ROS 2, by rclpy, which comes with an installation of ROS."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from mars2d.core.errors import InputError
from mars2d.scenario.scenario import Scenario
from mars2d.world.loop import RealTime
from mars2d.world.ros.messages import WORLD, clock, fill, odometry, scan, transform
from mars2d.world.world import World

PATIENCE = 0.5
"""How long a command holds if no other comes, seconds of simulated time."""

MEANT = {("v", "omega"): ("x", "angular"), ("vx", "vy"): ("x", "y")}
"""Which parts of a twist the commands of a drive are."""

ABSENT = (
    "mars2d ros needs ROS 2 with its Python library rclpy: install ROS 2 as on "
    "https://docs.ros.org, and source its setup file, as: source /opt/ros/jazzy/setup.bash"
)


class Bridge:
    """Publishes a run, and takes commands for its robots.

    ``/clock``, ``/tf``; for each robot ``/NAME/odom``, ``/NAME/SENSOR`` of its range finders, and
    ``/NAME/cmd_vel``, a geometry_msgs/TwistStamped. A robot that gets commands follows them; one
    that has got none for half a second follows its law, or stands still.

    speed: simulated seconds per second. Raises InputError without rclpy, and for a drive whose
    commands are no twist.
    """

    def __init__(self, world: World, speed: float = 1.0) -> None:
        check_drives(world.scenario)
        try:
            self._rclpy: Any = import_module("rclpy")
            clocks, frames, twists, odometries, scans = (
                import_module(f"{name}.msg")
                for name in (
                    "rosgraph_msgs",
                    "tf2_msgs",
                    "geometry_msgs",
                    "nav_msgs",
                    "sensor_msgs",
                )
            )
        except ImportError:
            raise InputError(ABSENT) from None
        self._world, self._speed = world, speed
        self._types: Any = frames.TFMessage, twists.TransformStamped
        self._clock_type, self._odometry_type = clocks.Clock, odometries.Odometry
        self._scan_type = scans.LaserScan
        self._rclpy.init()
        self._node: Any = self._rclpy.create_node("mars2d")
        publisher = self._node.create_publisher
        self._clock = publisher(clocks.Clock, "/clock", 10)
        self._tf = publisher(frames.TFMessage, "/tf", 10)
        self._commands: dict[str, tuple[float, tuple[float, float]]] = {}
        self._odometry, self._scans = [], []
        for index, robot in enumerate(world.scenario.robots):
            name = str(robot.name)
            self._odometry.append(publisher(odometries.Odometry, f"/{name}/odom", 10))
            self._node.create_subscription(
                twists.TwistStamped, f"/{name}/cmd_vel", self._taker(name, robot.drive), 10
            )
            for sensor in robot.sensors:
                fan = sensor.fan
                if fan is not None and not fan.cone:
                    topic = publisher(scans.LaserScan, f"/{name}/{sensor.key}", 10)
                    self._scans.append((index, sensor, fan, topic))

    def _taker(self, name: str, drive: Any) -> Any:
        """Return a function that keeps the commands of a robot."""
        first, second = MEANT[tuple(each.name for each in drive.quantities)]

        def take(message: Any) -> None:
            twist = message.twist
            other = twist.angular.z if second == "angular" else getattr(twist.linear, second)
            self._commands[name] = self._world.time, (getattr(twist.linear, first), other)

        return take

    def run(self) -> None:
        """Run to the end, in real time times the speed."""
        world, wait = self._world, RealTime(self._speed)
        try:
            while not world.over and self._rclpy.ok():
                wait(world)
                self._rclpy.spin_once(self._node, timeout_sec=0.0)
                world.observe()
                self._publish()
                since = world.time - PATIENCE
                recent = {k: u for k, (then, u) in self._commands.items() if then >= since}
                world.step(recent)
        finally:
            self._node.destroy_node()
            self._rclpy.try_shutdown()

    def _publish(self) -> None:
        world = self._world
        now, (frames, stamped) = world.time, self._types
        self._clock.publish(fill(self._clock_type(), clock(now)))
        links = []
        for index, robot in enumerate(world.scenario.robots):
            name, pose = str(robot.name), world.pose[:, index].tolist()
            links.append(transform(now, WORLD, name, pose))
            tree = odometry(now, name, pose, world.velocity[:, index].tolist())
            self._odometry[index].publish(fill(self._odometry_type(), tree))
        for index, sensor, fan, topic in self._scans:
            name = str(world.scenario.robots[index].name)
            frame = f"{name}/{sensor.key}"
            links.append(transform(now, name, frame, sensor.placed(np.zeros(3)).tolist()))
            reading: Any = world.robots[index].sense[sensor.key]
            period = sensor.period(world.scenario.sampling_time) * world.scenario.sampling_time
            topic.publish(fill(self._scan_type(), scan(now, frame, fan, reading, period)))
        self._tf.publish(frames(transforms=[fill(stamped(), link) for link in links]))


def check_drives(scenario: Scenario) -> None:
    """Refuse a robot whose commands are no twist."""
    for robot in scenario.robots:
        names = tuple(each.name for each in robot.drive.quantities)
        if names not in MEANT:
            raise InputError(
                f"{robot.name}: cmd_vel is a twist, and its {type(robot.drive).__name__} takes "
                f"{names[0]} and {names[1]}; expected a drive that takes v and omega, or vx and vy"
            )
