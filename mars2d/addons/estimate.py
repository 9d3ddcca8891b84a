"""The pose that a robot estimates by its odometry, drawn with the ellipse of its uncertainty."""

from __future__ import annotations

from math import floor, log, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.addons.base import Addon
from mars2d.core.arithmetic import ROUNDING, cosine_sine, cosines_sines
from mars2d.core.description import entry, number, text
from mars2d.core.errors import InputError
from mars2d.core.interfaces import WorldLike
from mars2d.core.scene import Scene, color, faded
from mars2d.geometry.dead_reckoning import covariance_after_arc

Float = NDArray[np.float64]

CORNERS = 72
"""The corners of an ellipse that is drawn."""

MIN_VARIANCE = 1e-12
"""The smallest variance of an ellipse, m^2: at the start it would be a point."""


def ellipse(center: ArrayLike, covariance: ArrayLike, probability: float = 0.95) -> Float:
    """Return the corners (72, 2) of the ellipse that holds a normal distribution's points.

    center: (2,) metres. covariance: (2, 2), or larger with x and y first.
    probability: of a point to lie within, 0 < probability < 1.

    >>> ellipse((1, 0), [[0.04, 0], [0, 0.01]], 0.393469).max(axis=0).round(6).tolist()
    [1.2, 0.1]
    """
    spread = np.asarray(covariance, dtype=float)[:2, :2] + MIN_VARIANCE * np.eye(2)
    angles = np.linspace(0, 2 * pi, CORNERS, endpoint=False)
    circle = sqrt(-2 * log(1 - probability)) * np.array(cosines_sines(angles))
    return np.asarray(np.asarray(center, dtype=float)[:2] + (np.linalg.cholesky(spread) @ circle).T)


class Estimate(Addon):
    """Draws the pose that a robot estimates by its odometry, and the ellipse of its uncertainty.

    The covariance grows with each turn of the wheels by the sensor's `drift`. An ellipse is kept
    every `every` seconds, so that one sees it grow. The robot needs a sensor Odometry
    and wheels on one axle.

    Source: R. Siegwart, I. Nourbakhsh, D. Scaramuzza, Introduction to Autonomous Mobile Robots
    (2011), section 5.2.4.
    """

    robot: str | None = text(
        default=None, optional=True, doc="the robot; None: the first one with odometry",
        names="robot",
    )  # fmt: skip
    probability: float = number(
        default=0.95,
        above=0,
        high=1 - 1e-9,
        doc="the probability that the robot is within the ellipse",
    )
    every: float = number(
        default=10.0, above=0, high=1e6, unit="s", doc="time between two ellipses that are kept"
    )
    color: str = entry(default="#d55e00", check=color, doc="its colour")

    def on_start(self, world: WorldLike) -> None:
        """Find the robot and its sensor; raise InputError if there is none."""
        self._index, self._sensor = self._found(world)
        robot = world.scenario.robots[self._index]
        axle = getattr(robot.drive, "wheel_semiaxis", None)
        if axle is None:
            raise InputError(
                f"Estimate: {robot.name} drives by {type(robot.drive).__name__}, which has no two "
                "wheels on one axle; give it a Unicycle() or Differential()"
            )
        self._semiaxis = float(axle)
        start = self._sensor.origin == "start"
        self._origin = np.array(robot.pose if start else (0.0, 0.0, 0.0))
        self._last: Float | None = None
        self._path: list[Float] = []
        self._kept: list[Float] = []
        self.covariance = np.zeros((3, 3))

    def _found(self, world: WorldLike) -> tuple[int, Any]:
        """Return the robot's index, and its sensor."""
        robots = world.scenario.robots
        if self.robot is not None:
            world.scenario.index_of("Estimate.robot", self.robot)
        for index, robot in enumerate(robots):
            for sensor in robot.sensors:
                reckons = hasattr(sensor, "drift") and hasattr(sensor, "origin")
                if reckons and self.robot in (None, robot.name):
                    return index, sensor
        who = "no robot has a" if self.robot is None else f"{self.robot} has no"
        raise InputError(f"Estimate: {who} sensor Odometry, whose estimate could be drawn")

    def on_sensed(self, world: WorldLike) -> None:
        """Take the latest reading, once, unless it is lost or not yet there; keep ellipses."""
        reading = getattr(world.robots[self._index].sense, self._sensor.key)
        if reading is not self._last and np.isfinite(reading).all():
            self._last = reading
            if self._path:
                before, drift = self._path[-1], self._sensor.drift
                self.covariance = covariance_after_arc(
                    self.covariance, before, reading, self._semiaxis, drift
                )
            self._path.append(np.array(reading))
        if len(self._kept) < floor(world.time / self.every + ROUNDING):
            self._kept.append(self._ellipse())

    def _ellipse(self) -> Float:
        """Return the corners of the ellipse now, in the world's frame."""
        center = self._path[-1] if self._path else np.zeros(3)
        return self._placed(ellipse(center, self.covariance, self.probability))

    def _placed(self, points: ArrayLike) -> Float:
        """Return points (k, 2) of the estimate's frame in that of the world."""
        x, y, theta = self._origin.tolist()
        ahead, left = np.asarray(points, dtype=float)[:, :2].T
        c, s = cosine_sine(theta)
        return np.column_stack([x + c * ahead - s * left, y + s * ahead + c * left])

    def on_draw(self, world: WorldLike, scene: Scene) -> None:  # noqa: ARG002
        """Draw the estimated path, the ellipses that were kept, and the last one."""
        if not self._path:
            return
        for rim in self._kept:
            scene.polygon(rim, fill=faded(self.color, 0.1), stroke=self.color, width=1.2)
        scene.polygon(self._ellipse(), fill=faded(self.color, 0.15), stroke=self.color, width=1.6)
        path = self._placed(np.array(self._path))
        scene.line(path, stroke=self.color, width=1.6, style="--")
        scene.circle(path[-1], 0.0, fill=self.color, stroke="#ffffff", pixels=4.5)
