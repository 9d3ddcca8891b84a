"""How robots move: the drives."""

from mars2d.bodies.base import Drive
from mars2d.bodies.car import Car
from mars2d.bodies.differential import Differential
from mars2d.bodies.holonomic import Holonomic
from mars2d.bodies.unicycle import Unicycle

__all__ = ["Car", "Differential", "Drive", "Holonomic", "Unicycle"]
