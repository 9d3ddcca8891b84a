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

if TYPE_CHECKING:
    from mars2d.addons import Addon
    from mars2d.bodies import Car, Differential, Drive, Dubins, Holonomic, Omni, Unicycle
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
    from mars2d.study.run import sweep
    from mars2d.study.table import Table
    from mars2d.tournaments.tournament import tournament
    from mars2d.window.entry import run
    from mars2d.world.record import Record, load
    from mars2d.world.team_view import WorldView
    from mars2d.world.views import RobotView
    from mars2d.world.world import World

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
    "Omni",
    "Prediction",
    "RandomStarts",
    "Range",
    "Record",
    "Robot",
    "RobotView",
    "Scenario",
    "Sensor",
    "Table",
    "Unicycle",
    "Within",
    "World",
    "WorldView",
    "__version__",
    "load",
    "load_law",
    "load_scenario",
    "run",
    "save_scenario",
    "sweep",
    "tournament",
]

_HOMES = {
    "addons": ("Addon",),
    "bodies": ("Car", "Differential", "Drive", "Dubins", "Holonomic", "Omni", "Unicycle"),
    "core.errors": ("InputError", "LawError", "Mars2dError"),
    "output.pages.notebook": ("scenario_svg",),
    "scenario.animation": ("Animation",),
    "scenario.experiment": ("load_law", "load_scenario"),
    "scenario.material_pair": ("MaterialPair",),
    "scenario.neighbours": (
        "Delaunay", "Everyone", "Graph", "Nearest", "Neighbourhood", "Within",
    ),
    "scenario.parameters": ("Range",),
    "scenario.prediction": ("Prediction",),
    "scenario.random_starts": ("RandomStarts",),
    "scenario.robot": ("Robot",),
    "scenario.scenario": ("Scenario",),
    "scenario.toml_file": ("save_scenario",),
    "sensors": ("Sensor",),
    "study.run": ("sweep",),
    "study.table": ("Table",),
    "tournaments.tournament": ("tournament",),
    "window.entry": ("run",),
    "world.record": ("Record", "load"),
    "world.team_view": ("WorldView",),
    "world.views": ("RobotView",),
    "world.world": ("World",),
}  # fmt: skip
"""The modules of the names, which are imported when a name is first asked for."""

_ROOMS = ("addons", "bodies", "geometry", "scenario", "sensors")
"""Packages of further public names."""


def __getattr__(name: str) -> Any:
    if name in _ROOMS:
        return import_module(f"{__name__}.{name}")
    for module, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
