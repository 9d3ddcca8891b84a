"""MARS2D: teams of mobile robots in the plane, with real contact physics.

>>> import mars2d
>>> record = mars2d.run("random_walk", stop_time=10)
>>> record.pose.shape
(11, 3, 2)
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from mars2d.core import interrupt  # noqa: F401 - first: Ctrl-C while the others are imported

# isort: split
from mars2d.addons import Addon
from mars2d.bodies import Car, Differential, Drive, Dubins, Holonomic, Unicycle
from mars2d.core.errors import InputError, LawError, Mars2dError
from mars2d.scenario.animation import Animation
from mars2d.scenario.experiment import load_law, load_scenario
from mars2d.scenario.material_pair import MaterialPair
from mars2d.scenario.neighbours import Delaunay, Everyone, Graph, Nearest, Neighbourhood, Within
from mars2d.scenario.parameters import Range
from mars2d.scenario.prediction import Prediction
from mars2d.scenario.random_starts import RandomStarts
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.toml_file import save_scenario
from mars2d.sensors import Sensor
from mars2d.world.record import Record, load
from mars2d.world.world import World

if TYPE_CHECKING:
    from mars2d.study.sweep import sweep
    from mars2d.study.table import Table
    from mars2d.tournaments.tournament import tournament
    from mars2d.window.run import run

__version__ = "0.1.0"

__all__ = [
    "Addon",
    "Animation",
    "Car",
    "Delaunay",
    "Differential",
    "Drive",
    "Dubins",
    "Everyone",
    "Graph",
    "Holonomic",
    "InputError",
    "LawError",
    "Mars2dError",
    "MaterialPair",
    "Nearest",
    "Neighbourhood",
    "Prediction",
    "RandomStarts",
    "Range",
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
    "load_scenario",
    "run",
    "save_scenario",
    "sweep",
    "tournament",
]

_LATER = {
    "Table": "mars2d.study.table",
    "run": "mars2d.window.run",
    "sweep": "mars2d.study.sweep",
    "tournament": "mars2d.tournaments.tournament",
}
"""The names that are imported when they are first asked for: not every program needs them."""


def _picture(scenario: Scenario) -> str:
    """Return the picture of a scenario that a notebook shows."""
    from mars2d.output.pages.notebook import scenario_svg

    return scenario_svg(scenario)


Scenario._repr_svg_ = _picture  # scenarios know nothing of pictures


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_LATER[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
