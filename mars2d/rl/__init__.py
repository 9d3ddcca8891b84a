"""Environments for learners: gymnasium for one robot, PettingZoo for several.

>>> import gymnasium
>>> import mars2d.rl  # which makes its environments known to gymnasium
>>> environment = gymnasium.make("mars2d/Pursuit-v0")
"""

from mars2d.rl.environment import Environment
from mars2d.rl.parallel import ParallelEnvironment
from mars2d.rl.registration import register

__all__ = ["Environment", "ParallelEnvironment"]

register()
