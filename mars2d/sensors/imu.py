"""The inertial measurement unit: accelerations and rate of turn."""

from __future__ import annotations

from math import sqrt
from typing import Any, ClassVar

import numpy as np

from mars2d.core.arithmetic import cosine_sine, norm
from mars2d.core.checks import several
from mars2d.core.description import entry
from mars2d.core.interfaces import RobotLike
from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene
from mars2d.sensors.base import Float, Sensor, spread
from mars2d.sensors.surroundings import Surroundings

ARROW = 0.2
"""The length of an arrow for an acceleration of 1 m/s^2, metres."""

_three = several(-1e6, 1e6, 3, "three numbers, for (ax, ay) [m/s^2] and omega [rad/s]")
_three_spreads = several(0.0, 1e6, 3, "three numbers >= 0, for (ax, ay) and omega")


class Imu(Sensor):
    """Measures acceleration ahead and to the left [m/s^2] and spin [rad/s], in its own frame.

    The reading is an array (3,) = (ax, ay, omega), means over the control steps since the reading
    before: over the last one, or at a lower `rate` over several. With (u, w) the mount's velocity
    ahead and to the left, omega is in each the change of heading over the sampling time T, and
    ax = (change of u) / T - omega w, ay = (change of w) / T + omega u, with u and w at the end of
    the step. That is exact where velocities change at control steps only, as they do in
    free motion, and else to the first order of T. At the start there is no last step: the
    means are 0, and only the bias, the walk and the noise are read.

    Two errors are added that last: `bias`, and a random walk that begins at 0 and gains a standard
    deviation of `bias_walk` times the root of the time. `noise` is the density of white noise: a
    mean over t seconds is off by the deviation noise / sqrt(t), and a heading that is summed up
    from omega for t seconds by noise sqrt(t), a random walk of the angle.

    The robot stands upright on a level floor, so gravity does not show.

    Sources: Titterton and Weston, Strapdown Inertial Navigation Technology (2004), sections 3.4 and
    4.4; IEEE Std 952, on specifying gyroscopes, annex C (angle random walk, rate random walk).
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (
        Quantity("ax", "m/s^2"),
        Quantity("ay", "m/s^2"),
        Quantity("omega", "rad/s"),
    )

    averages: ClassVar[bool] = True

    noise: float | tuple[float, ...] = entry(
        default=0.0, check=spread("a density"),
        unit="m/s^2/sqrt(Hz), m/s^2/sqrt(Hz), rad/s/sqrt(Hz)",
        doc="density of the white noise",
    )  # fmt: skip
    bias: tuple[float, float, float] = entry(
        default=(0.0, 0.0, 0.0), check=_three, unit="m/s^2, m/s^2, rad/s", doc="constant errors"
    )
    bias_walk: tuple[float, float, float] = entry(
        default=(0.0, 0.0, 0.0), check=_three_spreads,
        unit="m/s^2/sqrt(s), m/s^2/sqrt(s), rad/s/sqrt(s)",
        doc="deviation of the errors' change in one second; it grows with the root of time",
    )  # fmt: skip

    def on_start(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> None:  # noqa: ARG002
        """Begin without a step before."""
        self._last: tuple[float, float, float] | None = None
        self._sum, self._steps = np.zeros(3), 0  # of the control steps since the last reading
        self._period = self.period(world.sampling_time)
        self._walked = np.zeros(3)

    def on_step(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> None:
        """Take the means over the last control step."""
        if self._steps == self._period:  # they have been read
            self._sum, self._steps = np.zeros(3), 0
        heading = float(self.placed(robot.pose)[2])
        ahead, left = self._speed(robot, heading)
        if self._last is not None:
            seconds = world.sampling_time
            had_ahead, had_left, had_heading = self._last
            omega = (heading - had_heading) / seconds
            ax = (ahead - had_ahead) / seconds - omega * left
            ay = (left - had_left) / seconds + omega * ahead
            self._sum, self._steps = self._sum + np.array([ax, ay, omega]), self._steps + 1
            if any(self.bias_walk):
                step = np.array(self.bias_walk) * sqrt(seconds)
                self._walked = self._walked + step * rng.standard_normal(3)
        self._last = ahead, left, heading

    def _speed(self, robot: RobotLike, heading: float) -> tuple[float, float]:
        """Return the mount's velocity [m/s] ahead and to the left of its own heading."""
        vx, vy, omega = robot.velocity.tolist()
        x, y = (self.placed(robot.pose) - robot.pose)[:2].tolist()
        vx, vy = vx - omega * y, vy + omega * x
        c, s = cosine_sine(heading)
        return c * vx + s * vy, c * vy - s * vx

    def read(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> Float:  # noqa: ARG002
        """Return the means (3,) over the time since the last reading, with the bias."""
        return self._sum / max(self._steps, 1) + self.bias + self._walked

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:  # noqa: ARG002
        """Draw the acceleration as an arrow, a metre for 5 m/s^2."""
        x, y, theta = self.placed(pose).tolist()
        ax, ay, _ = np.asarray(reading, dtype=float).tolist()
        size = float(norm(ax, ay))
        if 1e-3 < size < np.inf:
            c, s = (ARROW * each for each in cosine_sine(theta))
            tip = (x + c * ax - s * ay, y + s * ax + c * ay)
            scene.arrow((x, y), tip, fill="#d55e00", stroke="#ffffff", width=2.0)
