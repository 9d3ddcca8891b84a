"""Motion without forces: when things touch, a robot stops, or nothing happens."""

from __future__ import annotations

from array import array

import numpy as np
from numpy.typing import NDArray

from mars2d.physics.motion import Motion, repeated
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]


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
