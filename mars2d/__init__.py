"""MARS2D: teams of mobile robots in the plane, with real contact physics."""
__version__ = "0.1.0"
from mars2d.bodies import Holonomic, Unicycle
from mars2d.scenario import Animation, Robot, Scenario
