"""The frozen description of an experiment, its files and its laws."""

from mars2d.scenario.animation import Animation
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import (
    Experiment,
    load_law,
    load_scenario,
    open_experiment,
    open_module,
)
from mars2d.scenario.neighbours import Delaunay, Everyone, Graph, Nearest, Neighbourhood, Within
from mars2d.scenario.parameters import Range
from mars2d.scenario.prediction import Prediction
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.toml_file import save_scenario

__all__ = [
    "Animation",
    "Delaunay",
    "Everyone",
    "Experiment",
    "Graph",
    "Nearest",
    "Neighbourhood",
    "Prediction",
    "Range",
    "Robot",
    "Scenario",
    "Within",
    "examples",
    "load_law",
    "load_scenario",
    "open_experiment",
    "open_module",
    "save_scenario",
]
