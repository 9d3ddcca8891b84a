"""MARS2D: teams of mobile robots in the plane, with real contact physics.

>>> import mars2d
>>> record = mars2d.run("random_walk", stop_time=10)
>>> record.pose.shape
(11, 3, 2)
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from mars2d import beginning  # noqa: F401 - first, for Ctrl-C while the others are imported

# isort: split
from mars2d.addons import Addon
from mars2d.animation import Animation
from mars2d.bodies import Car, Differential, Drive, Holonomic, Unicycle
from mars2d.errors import InputError, LawError, Mars2dError
from mars2d.files import load_law
from mars2d.neighbours import Delaunay, Everyone, Graph, Nearest, Neighbourhood, Within
from mars2d.prediction import Prediction
from mars2d.record import Record, load
from mars2d.robot import Robot
from mars2d.scenario import Scenario
from mars2d.sensors import Sensor
from mars2d.session import run
from mars2d.world import World

if TYPE_CHECKING:
    from mars2d.study.sweep import sweep
    from mars2d.study.table import Table
    from mars2d.study.tournament.tournament import tournament

__version__ = "0.1.0"

__all__ = [
    "Addon",
    "Animation",
    "Car",
    "Delaunay",
    "Differential",
    "Drive",
    "Everyone",
    "Graph",
    "Holonomic",
    "InputError",
    "LawError",
    "Mars2dError",
    "Nearest",
    "Neighbourhood",
    "Prediction",
    "Record",
    "Robot",
    "Scenario",
    "Sensor",
    "Table",
    "Unicycle",
    "Within",
    "World",
    "__version__",
    "load",
    "load_law",
    "run",
    "sweep",
    "tournament",
]

_OF_MANY_RUNS = {
    "Table": "mars2d.study.table",
    "sweep": "mars2d.study.sweep",
    "tournament": "mars2d.study.tournament.tournament",
}
"""What is imported when it is first asked for: most programs run one experiment."""


def __getattr__(name: str) -> Any:
    if name not in _OF_MANY_RUNS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_OF_MANY_RUNS[name]), name)
