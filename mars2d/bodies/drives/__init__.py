"""Drives: how a command becomes the motion of a robot."""

from mars2d.bodies.drives.base import Drive
from mars2d.bodies.drives.car import Car
from mars2d.bodies.drives.dubins import Dubins
from mars2d.bodies.drives.holonomic import Holonomic
from mars2d.bodies.drives.omni import Omni
from mars2d.bodies.drives.wheeled import Differential, Unicycle

__all__ = ["Car", "Differential", "Drive", "Dubins", "Holonomic", "Omni", "Unicycle"]
