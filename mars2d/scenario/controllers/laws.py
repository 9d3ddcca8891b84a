"""The ready-made laws of robots: by hand, to waypoints, after a robot, at random, along walls."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from math import inf, pi
from typing import Any, ClassVar

import numpy as np

from mars2d.core.arithmetic import angle_of, cosines_sines, norm
from mars2d.core.description import choice, number, text
from mars2d.core.interfaces import ScenarioLike
from mars2d.geometry.bearings import beam_angles
from mars2d.scenario.controllers.base import Command, Controller, Paced, gone, steered, still
from mars2d.sensors.base import Float, Sensor, sight_angle
from mars2d.sensors.proximity import Proximity
from mars2d.sensors.range_finder import RangeFinder


class ByHand(Controller):
    """Waits for a person: the window lets you drive it at once, by keys or a game controller.

    Without a window, and when nobody drives it, it stands still.
    """

    title: ClassVar[str] = "driven by hand"

    def __call__(self, robot: Any) -> Command:
        """Return the command to stand still."""
        return still(robot.drive)


class FollowWaypoints(Paced):
    """Goes along its waypoints, one after the other, and stops at the last.

    The waypoints are those of the add-on `Waypoints`, which also says how near is there. With d the
    distance to the next one, its speed is min(gain d, speed): before the last one it slows down. A
    robot without waypoints stands still.
    """

    title: ClassVar[str] = "along its waypoints"

    gain: float = number(
        default=1.0, above=0, high=100, unit="1/s", doc="speed per metre to the last waypoint"
    )

    def __call__(self, robot: Any) -> Command:
        """Return the command that goes to the next waypoint."""
        ways = getattr(robot.world.addons, "waypoints", None)
        if ways is None or ways.arrived(robot.index):
            return still(robot.drive)
        (gx, gy), (x, y, theta) = ways.goal(robot.index), robot.pose.tolist()
        last = len(ways.routes[robot.index]) - ways.reached[robot.index] == 1
        speed = min(self.gain * norm(gx - x, gy - y), self.speed) if last else self.speed
        return steered(robot.drive, theta, angle_of(gy - y, gx - x), speed)

    def want(self, scenario: ScenarioLike, index: int) -> str:
        """Return what a robot lacks to be moved by this law: waypoints."""
        ways = (addon for addon in scenario.addons if addon.key == "waypoints")
        routes = getattr(next(ways, None), "routes", ())
        return "" if index < len(routes) and len(routes[index]) else "a waypoint"


class FollowRobot(Paced):
    """Follows another robot at a distance, and waits where it is nearer.

    With d the distance of the centres, its speed is min(gain (d - distance), speed). So behind a
    leader that goes straight at v it stays v / gain farther back than `distance`. It needs to see
    the other as a neighbour.
    """

    title: ClassVar[str] = "after another robot"

    leader: str | None = text(
        default=None, optional=True, doc="the name of the other robot; None: its nearest neighbour",
        names="robot",
    )  # fmt: skip
    distance: float = number(
        default=0.6,
        above=0,
        high=1e3,
        unit="m",
        doc="distance from the other's centre at which it stops",
    )
    gain: float = number(
        default=2.0, above=0, high=100, unit="1/s", doc="speed per metre beyond the distance"
    )

    def __call__(self, robot: Any) -> Command:
        """Return the command that goes to the leader."""
        x, y, theta = robot.pose.tolist()
        seen = [
            each.position - (x, y)
            for each in robot.neighbours
            if self.leader is None or each.name == self.leader
        ]
        if not seen:
            return still(robot.drive)
        dx, dy = min((place.tolist() for place in seen), key=lambda place: norm(*place))
        speed = min(self.gain * (norm(dx, dy) - self.distance), self.speed)
        if speed <= 0:
            return still(robot.drive)
        return steered(robot.drive, theta, angle_of(dy, dx), speed)

    def want(self, scenario: ScenarioLike, index: int) -> str:
        """Return what a robot lacks to be moved by this law: a robot to follow."""
        others = [robot.name for i, robot in enumerate(scenario.robots) if i != index]
        if self.leader is None:
            return "" if others else "another robot"
        return "" if self.leader in others else f"a robot called {self.leader}"


HALF = pi / 3
"""A drive that moves in any direction turns round, and up to this much to either side, radians."""


class Wander(Paced):
    """Goes straight on until something is near, backs off in a bend at random, and goes on.

    It backs for a time that is even in (turn / 2, 3 turn / 2), to a side at random. A drive that
    moves in any direction turns round instead, off by an angle that is even in +-60 degrees.
    """

    title: ClassVar[str] = "at random"

    needs: ClassVar[tuple[Sensor, ...]] = (Proximity(range=0.4, field_of_view=2.0),)

    turn: float = number(default=1.5, above=0, high=1e3, unit="s", doc="mean time of backing off")
    sensor: str = text(
        default="proximity", doc="the name of its sensor, a Proximity or a Bumper", names="sensor"
    )

    @property
    def reads(self) -> Sequence[str]:
        """The name of its sensor."""
        return (self.sensor,)

    def __call__(self, robot: Any) -> Generator[Command]:
        """Yield the commands."""
        drive, rng, way = robot.drive, robot.rng, 0.0
        share = min(self.speed / drive.max_linear_speed, 1.0)
        free = drive.holonomic or drive.frame == "world"
        while True:
            ahead = gone(drive, way, self.speed) if free else drive.steered(0.0, share)
            while not np.any(getattr(robot.sense, self.sensor)):
                yield ahead
            if free:
                way += pi + rng.uniform(-HALF, HALF)
                back = gone(drive, way, self.speed)
            else:
                back = drive.steered(rng.choice((-1.0, 1.0)), -share)
            for _ in range(max(round(rng.uniform(0.5, 1.5) * self.turn / robot.sampling_time), 1)):
                yield back


NEAR = 1.15
"""Beams up to this many times as long as the shortest one tell which way the wall is."""


class FollowWall(Paced):
    """Follows the nearest wall at a distance, by sensors alone; straight ahead until there is one.

    With e the distance to the nearest surface less `distance`, it heads along the surface, and
    atan(gain e) towards it. So along a straight wall e' = -v sin(atan(gain e)): for small e the
    error decays as exp(-v gain t). A drive that moves in the world's frame needs to know its
    heading as well.
    """

    title: ClassVar[str] = "along walls"

    needs: ClassVar[tuple[Sensor, ...]] = (RangeFinder(beams=72, range=2.0),)

    distance: float = number(
        default=0.5, above=0, high=1e3, unit="m", doc="from the sensor to the wall"
    )
    side: str = choice(default="left", of=("left", "right"), doc="the side of the wall")
    gain: float = number(
        default=3.0, above=0, high=100, unit="1/m", doc="how steeply it returns to its distance"
    )
    sensor: str = text(
        default="range_finder", doc="the name of its sensor, a RangeFinder or a SonarRing",
        names="sensor",
    )  # fmt: skip
    field_of_view: float = sight_angle(default=2 * pi, doc="that of its sensor")

    @property
    def reads(self) -> Sequence[str]:
        """The name of its sensor."""
        return (self.sensor,)

    def __call__(self, robot: Any) -> Command:
        """Return the command that goes along the wall; directions are from the robot's heading."""
        ranges = np.asarray(getattr(robot.sense, self.sensor))
        heading = float(robot.pose[2]) if robot.drive.frame == "world" else 0.0
        shortest = float(ranges.min(initial=inf))
        if shortest == inf:
            return steered(robot.drive, heading, heading, self.speed)
        angles = beam_angles(len(ranges), self.field_of_view)
        to_wall = _middle(angles, NEAR * shortest - ranges)
        sign = 1.0 if self.side == "left" else -1.0
        along = to_wall - sign * (pi / 2 - angle_of(self.gain * (shortest - self.distance), 1.0))
        return steered(robot.drive, heading, heading + along, self.speed)

    def want(self, scenario: ScenarioLike, index: int) -> str:
        """Return what a robot lacks to be moved by this law: a scanner."""
        if missing := super().want(scenario, index):
            return missing
        carried = scenario.robots[index].sensors
        sensor = next(each for each in carried if each.key == self.sensor)
        if getattr(sensor, "field_of_view", None) != self.field_of_view or sensor.fan is None:
            return "a scanner with the field of view of its law"
        return ""


def _middle(angles: Float, weights: Float) -> float:
    """Return the mean of angles (k,), weighted where the weights (k,) are positive."""
    c, s = cosines_sines(angles)
    weights = np.clip(weights, 0.0, None)
    return angle_of(float(weights @ s), float(weights @ c))
