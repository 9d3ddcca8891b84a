"""Checkers for your own parts: does a part work, and are its runs repeatable?

Each checker runs the part in a small world and raises `CheckError`, which lists everything that is
wrong. A test of a sensor is one line:

>>> from mars2d.sensors import Proximity
>>> check_sensor(Proximity(range=1.0))

The functions ``..._findings`` return all findings, including hints, instead of raising.
"""

from mars2d.testing.addon import addon_findings, check_addon
from mars2d.testing.controller import check_controller, controller_findings
from mars2d.testing.drive import check_drive, drive_findings
from mars2d.testing.finding import CheckError, Finding
from mars2d.testing.sensor import check_sensor, sensor_findings

__all__ = [
    "CheckError",
    "Finding",
    "addon_findings",
    "check_addon",
    "check_controller",
    "check_drive",
    "check_sensor",
    "controller_findings",
    "drive_findings",
    "sensor_findings",
]
