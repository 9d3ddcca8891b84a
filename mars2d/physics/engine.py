"""Motion with forces: exact where nothing touches, by the solver where something does; and without.

A body that nothing can reach during the next step is *carried*: robots go to the ends of their arcs
and props glide, both in closed form, in one step of any length. Bodies that may touch something
form islands, each of which is stepped as finely as it needs; see `islands`.
"""

from __future__ import annotations

from array import array
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from mars2d.physics.islands.settings import ITERATIONS, ITERATIONS_JOINTS, PUSH_DEPTH
from mars2d.physics.motion import Motion, repeated
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]


class Engine(Motion):
    """The motion of one world's bodies where ``Scenario.physics`` is "contact"."""

    def __init__(self, scenario: Scenario) -> None:
        """Build all that moves or is touched; see `Motion`."""
        super().__init__(scenario)
        iterations = ITERATIONS_JOINTS if scenario.ties else ITERATIONS  # the least of any island
        self._depth_of_push = PUSH_DEPTH * scenario.max_overlap * iterations

    @repeated
    def drive(self, twist: Float, duration: float, time: float) -> None:
        """Move all bodies for `duration` seconds under constant twists (3, n) of the robots.

        time: at the start, seconds, for the contacts. Raises FloatingPointError where a number is
        not finite, or nearly so: the motion is lost then.
        """
        try:
            self._mover.drive(array("d", twist.tobytes()), duration, time)
        except (ArithmeticError, ValueError) as error:
            raise FloatingPointError(
                "the bodies' motion is lost: a number is not finite, or nearly so"
            ) from error
        self._moved()

    # -- pulls --------------------------------------------------------------------------------

    @repeated
    def let_go(self) -> None:
        """End all pulls from outside."""
        self._mover.let_go()

    @repeated
    def pull(self, body: int, force: tuple[float, float], torque: float) -> None:
        """Let a force (x, y) [N] and a torque [N m] act on a body from now on."""
        self._mover.pull(body, [float(force[0]), float(force[1]), float(torque)])
        self._moved()

    def step_under(self, acceleration: float) -> float:
        """Return how long a pull may act unchanged, seconds.

        Within this time it presses a body no deeper into another than drives do. acceleration: of
        the body by the pull, m/s^2, > 0.
        """
        return sqrt(self._depth_of_push / acceleration)

    @repeated
    def withstands(self, body: int, force: float, torque: float) -> bool:
        """Return whether a body stays where it is held under a force [N] and torque [N m].

        A robot that follows its command is held by its drive, a prop at rest by the floor.
        """
        return bool(self._mover.withstands(body, float(force), float(torque)))


class Kinematics(Motion):
    """The motion of one world's bodies where ``Scenario.physics`` is "stop" or "ideal".

    Robots follow their commands exactly, and props glide. With "stop", a robot that would enter
    another body or an obstacle stands still for the rest of the control step, a prop for good. With
    "ideal", both go through. Contacts are noted either way, without impulses. Joints do not act.
    """

    def __init__(self, scenario: Scenario) -> None:
        """Take all that moves or is touched; see `Motion`."""
        super().__init__(scenario)
        self._stops = scenario.physics == "stop"

    @repeated
    def drive(self, twist: Float, duration: float, time: float) -> None:
        """Move all bodies for `duration` seconds under constant twists (3, n) of the robots.

        time: at the start, seconds, for the contacts.
        """
        self._mover.drift(array("d", twist.tobytes()), duration, time, self._stops)
        self._moved()
