"""Dead reckoning from the turning of the wheels."""

from __future__ import annotations

from math import sqrt
from typing import Any, ClassVar

import numpy as np

from mars2d.core.arithmetic import cosine_sine
from mars2d.core.checks import several
from mars2d.core.description import choice, entry, number, wrong
from mars2d.core.interfaces import RobotLike
from mars2d.core.quantity import Quantity
from mars2d.core.scene import Scene
from mars2d.geometry.dead_reckoning import draw_pose, sinc
from mars2d.sensors.base import Float, Sensor
from mars2d.sensors.surroundings import Surroundings

_scales = several(1e-9, 10.0, 2, "two scales (left, right), each >= 1e-9 and <= 10")


class Odometry(Sensor):
    """Estimates its own pose from the turning of its wheels: x [m], y [m], theta [rad].

    The reading is an array (3,); theta is not wrapped. It integrates the turning of the wheels
    exactly, as arcs. So where the wheels slip, the estimate goes on and the robot does not.

    On a drive of two wheels, their rims turn by v -+ wheel_semiaxis * omega. On any other drive
    three wheels that only measure roll along: two to the left and right of the pose, as far as the
    robot's radius (or the drive's own `wheel_semiaxis`), and one across. Each wheel's travel s is
    read as scale * s + drift * sqrt(|s|) * n with n a number of the standard normal distribution,
    and the spin is the difference of left and right over the believed distance of the wheels. The
    wheel across has the scale 1.

    The shared fields `noise`, `outliers` and `resolution` concern the reading and don't add up.

    Sources: Siegwart, Nourbakhsh and Scaramuzza, Introduction to Autonomous Mobile Robots (2011),
    section 5.2.4; Chong and Kleeman, Accurate odometry and error modelling for a mobile robot
    (ICRA 1997).
    """

    quantities: ClassVar[tuple[Quantity, ...]] = (
        Quantity("x", "m"),
        Quantity("y", "m"),
        Quantity("theta", "rad"),
    )

    drift: float = number(
        default=0.0, low=0, high=1e3, unit="sqrt(m)",
        doc="deviation of a wheel's travel after one metre; it grows with the root of the travel",
    )  # fmt: skip
    wheel_scale: tuple[float, float] = entry(
        default=(1.0, 1.0), check=_scales,
        doc="assumed over true radius of the left and the right wheel",
    )  # fmt: skip
    semiaxis_scale: float = number(
        default=1.0, low=1e-3, high=1e3, doc="assumed over true distance of the wheels"
    )
    origin: str = choice(
        default="start", of=("start", "world"),
        doc="the frame of the estimate: the pose at the start, or the world",
    )  # fmt: skip

    def _validate(self) -> None:
        super()._validate()
        if self.mount != (0.0, 0.0, 0.0):
            raise wrong("Odometry.mount", self.mount, "(0, 0, 0): it measures at the wheels")

    def on_start(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> None:  # noqa: ARG002
        """Begin at the origin."""
        own = getattr(robot.drive, "wheel_semiaxis", None)
        self._semiaxis = robot.radius if own is None else float(own)
        x, y, theta = robot.pose.tolist()
        self._estimate = (0.0, 0.0, 0.0) if self.origin == "start" else (x, y, theta)
        self._heading = theta

    def on_step(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> None:
        """Add the turning of the wheels in the last control step."""
        index, b, in_world = robot.index, self._semiaxis, robot.drive.frame == "world"
        for seconds, twist in world.driven:
            forward, left, spin = (seconds * twist[:, index]).tolist()
            if in_world:
                forward, left = _arc_of(forward, left, self._heading, spin)
                self._heading += spin
            self._roll([forward - b * spin, forward + b * spin, left], rng)
        if in_world:
            self._heading = float(robot.pose[2])

    def _roll(self, travel: list[float], rng: np.random.Generator) -> None:
        """Add the true travels of the wheels (left, right, across), metres."""
        left, right = (s * scale for s, scale in zip(travel, self.wheel_scale, strict=False))
        across = travel[2]
        if self.drift:
            errors = rng.standard_normal(3).tolist()
            off = [self.drift * sqrt(abs(s)) * n for s, n in zip(travel, errors, strict=True)]
            left, right, across = left + off[0], right + off[1], across + off[2]
        spin = (right - left) / (2 * self._semiaxis * self.semiaxis_scale)
        self._estimate = _moved(self._estimate, (left + right) / 2, across, spin)

    def read(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> Float:  # noqa: ARG002
        """Return the estimate (3,)."""
        return np.array(self._estimate)

    def draw(self, scene: Scene, pose: Float, reading: Any, color: str) -> None:  # noqa: ARG002
        """Draw the estimated pose, if it is one in the world's frame."""
        if self.origin == "world":
            draw_pose(scene, reading, color)


def _moved(
    pose: tuple[float, float, float], forward: float, left: float, spin: float
) -> tuple[float, float, float]:
    """Return the pose at the end of an arc.

    forward, left: metres along it in the frame that moves; spin: radians.
    """
    x, y, theta = pose
    middle, chord = theta + spin / 2, sinc(spin / 2)
    c, s = (chord * each for each in cosine_sine(middle))
    return x + c * forward - s * left, y + s * forward + c * left, theta + spin


def _arc_of(dx: float, dy: float, theta: float, spin: float) -> tuple[float, float]:
    """Return (forward, left) [m] along the arc that moves by (dx, dy) [m] from heading theta."""
    middle, chord = theta + spin / 2, sinc(spin / 2)
    if abs(chord) < 1e-9:  # a whole turn: no arc leads there
        chord = 1.0
    c, s = (each / chord for each in cosine_sine(middle))
    return c * dx + s * dy, c * dy - s * dx
