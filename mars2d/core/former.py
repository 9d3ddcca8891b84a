"""Former names of modules: importing one warns, and gives the names of the present module."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from importlib import import_module
from importlib.machinery import ModuleSpec
from types import ModuleType

NOW = {
    "animation": "scenario.animation",
    "bench": "reports.bench",
    "bench.scenes": "reports.bench.scenes",
    "bench.worlds": "reports.bench.worlds",
    "contact": "record.contact",
    "description": "core.description",
    "errors": "core.errors",
    "files": "scenario.experiment",
    "floor": "core.materials",
    "formats": "output.formats",
    "formats.mcap": "output.formats.mcap",
    "frame": "record.frame",
    "interventions": "record.interventions",
    "joints": "bodies",
    "listing": "scenario.python_file",
    "loop": "world.loop",
    "maps": "addons.maps",
    "message": "record.message",
    "neighbours": "scenario.neighbours",
    "output.contacts": "output.figures.contacts",
    "output.distances": "output.figures.distances",
    "output.figure": "output.figures.figure",
    "output.film": "output.films.film",
    "paper": "reports.paper",
    "paper.figures": "reports.paper.figures",
    "paper.make": "reports.paper.make",
    "physics.floor": "core.materials",
    "potential": "geometry.potential_field",
    "prediction": "scenario.prediction",
    "props": "bodies",
    "reckoning": "geometry.dead_reckoning",
    "registry": "scenario.registry",
    "rerun": "world.verify",
    "robot": "scenario.robot",
    "scene": "core.scene",
    "session": "window.run",
    "shapes": "geometry.shapes",
    "storage": "record.columns",
    "tessellation": "geometry.voronoi",
    "timeline": "world.timeline",
    "view": "window",
    "view.editor": "window.editor",
    "view.ghosts": "window.ghosts",
    "view.hand": "window.grab",
    "view.inspector": "window.inspector",
    "view.layout": "output.raster.layout",
    "view.painter": "output.raster.painter",
    "view.picture": "output.raster.picture",
    "window.hand": "window.grab",
}
"""The documented modules of earlier versions, and their present names."""


class FormerNames:
    """An import hook that finds the modules of `NOW`, after all other finders."""

    def find_spec(
        self,
        name: str,
        path: Sequence[str] | None = None,  # noqa: ARG002
        target: ModuleType | None = None,  # noqa: ARG002
    ) -> ModuleSpec | None:
        """Return the import spec of a former name, or None for any other name."""
        package, _, former = name.partition(".")
        if package != "mars2d" or former not in NOW:
            return None
        return ModuleSpec(name, self, is_package=True)  # type: ignore[arg-type]

    def create_module(self, spec: ModuleSpec) -> None:
        """Let the import system make an empty module."""

    def exec_module(self, module: ModuleType) -> None:
        """Issue a FutureWarning, and copy the names of the present module."""
        now = f"mars2d.{NOW[module.__name__.partition('.')[2]]}"
        warnings.warn(f"{module.__name__} is {now} now", FutureWarning, stacklevel=2)
        there = vars(import_module(now))
        own = vars(module)
        own.update({name: value for name, value in there.items() if name not in own})
