"""The option ``map``: run an experiment on a map from a file instead of its own."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mars2d.addons.map import Map
from mars2d.core import checks
from mars2d.core.description import wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.files import file_beside
from mars2d.core.plane import Outline, bounds_of, rectangle
from mars2d.scenario.options import override
from mars2d.scenario.scenario import Scenario


def reading_options() -> list[str]:
    """Return the names of the options for reading a map, such as ``unit``."""
    return [name for name in inspect.signature(Map.from_file).parameters if name != "path"]


@dataclass(frozen=True)
class MapOption:
    """The option ``map``, with options for reading it such as ``map.unit``.

    file: a file's name or a Map, None if it was not given. caller: a relative path is looked for
    beside this file, then in the current folder.
    """

    file: Any
    settings: dict[str, Any]
    caller: Path

    @classmethod
    def popped(cls, options: dict[str, Any], caller: Path) -> MapOption | None:
        """Take the option out of others; None if it is not among them."""
        names = [name for name in options if str(name).partition(".")[0] == "map"]
        if not names:
            return None
        given = {name: options.pop(name) for name in names}
        file = given.pop("map", None)
        known = reading_options()
        settings = {name.partition(".")[2]: value for name, value in given.items()}
        for name in settings:
            if name not in known:
                near = nearest(f"map.{name}", [f"map.{n}" for n in known])
                raise InputError(f"there is no option 'map.{name}'{near}")
        return cls(file, settings, caller)

    def value_for(self, default: Any) -> Any:
        """Return the value of a scenario function's parameter `map`, instead of its default."""
        file = default if self.file is None else self.file
        return MapOption(file, self.settings, self.caller).map() if self.settings else file

    def map(self) -> Map:
        """Return the map. Raises InputError if it can't be read."""
        if isinstance(self.file, Map) and not self.settings:
            return self.file
        if not isinstance(self.file, (str, Path)):
            if self.file is None or isinstance(self.file, Map):
                raise InputError(f"map.{next(iter(self.settings))} needs map=FILE as well")
            raise wrong("map", self.file, "the name of a map's file, such as 'plan.dxf', or a Map")
        from mars2d.addons.maps import SUFFIXES

        file = file_beside(Path(self.file), self.caller, "a map", SUFFIXES)
        return Map.from_file(file.absolute(), **self.settings)

    def override(self, scenario: Scenario, options: Mapping[str, Any]) -> Scenario:
        """Return the scenario with the map instead of its own, and other options set.

        A workspace that is the default one, or smaller than the map, becomes the rectangle around
        the map. Raises InputError, which names free room, if a body would stand in a wall.
        """
        return _with_map(scenario, options, self.map())


MARGIN = 1.0
"""The distance from a map's walls to the edge of a workspace made for it, metres."""

MAX_HINTS = 3
"""The number of bodies for which an error names free room."""

DEFAULT_WORKSPACE = Scenario.__dataclass_fields__["workspace"].default


def _with_map(scenario: Scenario, options: Mapping[str, Any], chart: Map) -> Scenario:
    """Return the scenario with a map instead of its own, and the options set."""
    rest = dict(options)
    for name in reading_options():
        if name in rest:  # as mars2d check has it
            raise InputError(f"there is no option {name!r}; did you mean 'map.{name}'?")
    workspace = _workspace_for(scenario, chart)
    if "workspace" in rest:
        workspace = rest.pop("workspace")
        if workspace is not None:
            workspace = checks.outline("Scenario.workspace", workspace, least=3)
    own = next((addon for addon in scenario.addons if isinstance(addon, Map)), None)
    if own is not None:  # keep its name and surface
        chart = own.replace(outlines=chart.outlines, walls=chart.walls)
    others = [addon for addon in scenario.addons if not isinstance(addon, Map)]
    bare = override(scenario.replace(addons=others, workspace=None), rest)
    try:
        return bare.replace(addons=[*bare.addons, chart], workspace=workspace)
    except InputError as error:
        raise InputError(f"{error}{_room(bare, chart, workspace)}") from error


def _workspace_for(scenario: Scenario, chart: Map) -> Outline | None:
    if scenario.workspace is None:
        return None
    xmin, xmax, ymin, ymax = bounds_of([p for o in chart.obstacles() for p in o])
    left, right, low, high = bounds_of(scenario.workspace)
    within = left <= xmin and xmax <= right and low <= ymin and ymax <= high
    if within and scenario.workspace != DEFAULT_WORKSPACE:
        return scenario.workspace
    return rectangle(xmin - MARGIN, xmax + MARGIN, ymin - MARGIN, ymax + MARGIN)


def _room(scenario: Scenario, chart: Map, workspace: Outline | None) -> str:
    """Return where bodies that stand in a wall, or outside, would have room."""
    from mars2d.addons.maps import nearest_room

    outlines = list(chart.obstacles())
    within = rectangle(*bounds_of([p for o in outlines for p in o]))
    hints: list[str] = []
    for i, body in enumerate(scenario.bodies):
        center, radius = body.bound
        place = nearest_room(center, radius, outlines, workspace or within)
        if place is None:
            return f"; there is no room for {body.name} anywhere"
        if place == center:
            continue
        if len(hints) == MAX_HINTS:
            return f"; {', '.join(hints)}, and others have none where they stand"
        place = nearest_room(center, radius, outlines, within) or place  # indoors first
        x, y, theta = body.pose
        x, y = x + place[0] - center[0], y + place[1] - center[1]
        kind, k = ("robots", i) if i < len(scenario.robots) else ("props", i)
        k -= 0 if kind == "robots" else len(scenario.robots)
        hints.append(f"{body.name} has room at {kind}.{k}.pose=({x:.3f}, {y:.3f}, {theta:.4g})")
        (x, y), r = place, radius
        outlines.append(rectangle(x - r, x + r, y - r, y + r))  # not for the next one as well
    return f"; {', '.join(hints)}" if hints else ""
