"""Checkers for your own parts: does a part work, and are its runs repeatable?

Each checker runs the part in a small world and raises `CheckError`, which lists everything that is
wrong. A test of a sensor is one line:

>>> from mars2d.sensors import Proximity
>>> check_sensor(Proximity(range=1.0))
"""

from mars2d.testing.addon import check_addon
from mars2d.testing.controller import check_controller
from mars2d.testing.sensor import check_sensor
from mars2d.testing.subject import CheckError, Finding

__all__ = [
    "CheckError",
    "Finding",
    "check_addon",
    "check_controller",
    "check_sensor",
]
