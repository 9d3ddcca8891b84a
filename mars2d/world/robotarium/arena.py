"""The arena of the Robotarium: robots that a script reads and drives, step by step."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.bodies import Differential
from mars2d.core.errors import InputError, shown
from mars2d.core.plane import rectangle, wrap
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.world.robotarium.placement import generate_initial_conditions
from mars2d.world.world import World

Float = NDArray[np.float64]

WIDTH, HEIGHT, DIAMETER, TIME_STEP = 3.2, 2.0, 0.11, 0.033  # m, m, m, s
MAX_LINEAR_SPEED, WHEEL_RADIUS, WHEEL_BASE, MAX_WHEEL_SPEED = 0.2, 0.016, 0.105, 12.5
"""The bounds of the robots: m/s, m, m, rad/s."""

MOST_ROBOTS = 50

LONGEST = 1e6
"""The time after which a script's run ends in any case, seconds."""


class Robotarium:
    """The arena of 3.2 m x 2 m, with the names and the order of calls of the Robotarium.

    number_of_robots: 1 to 50. initial_conditions: (3, n), the poses; empty: at random.
    show_figure, sim_in_real_time: taken and not used, since `mars2d robotarium` shows the run.
    Raises InputError for another number, or poses that do not fit.
    """

    def __init__(
        self,
        number_of_robots: int = -1,
        show_figure: bool = True,
        sim_in_real_time: bool = True,
        initial_conditions: ArrayLike = (),
    ) -> None:
        poses = np.asarray(initial_conditions, dtype=float)
        if not isinstance(number_of_robots, (int, np.integer)) or isinstance(
            number_of_robots, bool
        ):
            raise InputError(f"number_of_robots = {shown(number_of_robots)}: expected a number")
        count = int(number_of_robots)
        if count == -1 and poses.size:
            count = poses.shape[-1]
        if not 1 <= count <= MOST_ROBOTS:
            raise InputError(f"number_of_robots = {count}: expected 1 to {MOST_ROBOTS}")
        if poses.size and poses.shape != (3, count):
            raise InputError(
                f"initial_conditions of shape {poses.shape}: expected (3, {count}), x, y and theta"
            )
        self.number_of_robots, self.time_step = count, TIME_STEP
        self.robot_diameter, self.robot_radius = DIAMETER, DIAMETER / 2
        self.wheel_radius, self.base_length = WHEEL_RADIUS, WHEEL_BASE
        self.max_linear_velocity = MAX_LINEAR_SPEED
        self.max_angular_velocity = 2 * WHEEL_RADIUS * MAX_WHEEL_SPEED / WHEEL_BASE
        self.max_wheel_velocity = MAX_WHEEL_SPEED
        self.boundaries = [-WIDTH / 2, -HEIGHT / 2, WIDTH, HEIGHT]
        self.world = World(_scenario(count, poses if poses.size else None))
        self._wanted, self._read = np.zeros((2, count)), False
        self.outside = 0

    @cached_property
    def figure(self) -> Any:
        """A figure for a script's drawings, which is not shown."""
        from matplotlib.figure import Figure

        return Figure()

    @cached_property
    def axes(self) -> Any:
        """The axes of that figure, which show the arena in metres."""
        xmin, ymin, width, height = self.boundaries
        return self.figure.add_subplot(
            xlim=(xmin, xmin + width), ylim=(ymin, ymin + height), aspect="equal"
        )

    def get_number_of_robots(self) -> int:
        """Return how many robots there are."""
        return self.number_of_robots

    def get_poses(self) -> Float:
        """Return the poses (3, n): x, y [m], theta [rad, -pi to pi]; once in each step."""
        if self._read:
            raise InputError("get_poses() was called twice: call step() in between")
        self._read = True
        poses = self.world.pose.copy()
        poses[2] = wrap(poses[2])
        return poses

    def set_velocities(self, ids: ArrayLike, velocities: ArrayLike) -> None:
        """Set the commands (2, k) of robots: v [m/s] and omega [rad/s], from the next step on.

        ids: their numbers; the Robotarium's own simulator commands all robots, whatever they are.
        """
        wanted = np.array(velocities, dtype=float)
        numbers = np.atleast_1d(np.asarray(ids, dtype=int)).ravel()
        if wanted.shape == (2, self.number_of_robots):
            self._wanted = wanted
        elif wanted.shape == (2, len(numbers)) and len(numbers):
            self._wanted[:, numbers] = wanted
        else:
            raise InputError(
                f"set_velocities: velocities of shape {wanted.shape}: expected "
                f"(2, {self.number_of_robots})"
            )
        if not np.isfinite(wanted).all():
            raise InputError("set_velocities: velocities that are not finite")

    def step(self) -> None:
        """Move all robots for 0.033 s."""
        if not self._read:
            raise InputError("step() was called without get_poses() since the step before")
        self._read = False
        x, y = self.world.pose[:2]
        self.outside += int(((abs(x) > WIDTH / 2) | (abs(y) > HEIGHT / 2)).any())
        v, omega = self._wanted
        self.world.step([np.clip(v, -MAX_LINEAR_SPEED, MAX_LINEAR_SPEED), omega])

    def call_at_scripts_end(self) -> None:
        """End the run, and print how often the rules of the Robotarium were broken."""
        self.world.stop("the script has ended")
        print(self.judgement())

    def judgement(self) -> str:
        """Return how often robots collided, and in how many steps one was outside."""
        collisions = self.world.record.collisions
        return (
            f"{collisions} collisions; in {self.outside} steps a robot was outside the arena"
            if collisions or self.outside
            else "no collision, and nobody left the arena"
        )


def _scenario(count: int, poses: Float | None) -> Scenario:
    drive = Differential(
        command="twist",
        wheel_radius=WHEEL_RADIUS,
        wheel_semiaxis=WHEEL_BASE / 2,
        max_linear_speed=WHEEL_RADIUS * MAX_WHEEL_SPEED,
    )
    robot = Robot(diameter=DIAMETER, drive=drive)
    places = generate_initial_conditions(count) if poses is None else poses
    return Scenario(
        title="Robotarium",
        robots=[robot.replace(pose=tuple(pose)) for pose in places.T.tolist()],
        workspace=rectangle(-WIDTH / 2, WIDTH / 2, -HEIGHT / 2, HEIGHT / 2),
        on_exit="ignore",
        sampling_time=TIME_STEP,
        stop_time=LONGEST,
    )
