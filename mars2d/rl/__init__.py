"""Environments for learners: gymnasium for one robot, PettingZoo for several.

The name says which module gymnasium has to import first; importing it registers all environments.

>>> import gymnasium
>>> environment = gymnasium.make("mars2d.rl:mars2d/Pursuit-v0")
"""

from mars2d.rl.environment import Environment
from mars2d.rl.parallel import ParallelEnvironment
from mars2d.rl.registration import register
from mars2d.rl.vector import VectorEnvironment

__all__ = ["Environment", "ParallelEnvironment", "VectorEnvironment"]

register()
