"""The frozen description of an experiment, its files and its laws."""

from mars2d.scenario.experiment import load_law, open_experiment, open_module
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

__all__ = ["Robot", "Scenario", "load_law", "open_experiment", "open_module"]
