"""The option ``map``: run an experiment on a map from a file instead of its own."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

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


class MapOption(NamedTuple):
    """The option ``map``, with options for reading it such as ``map.unit``.

    file: a file's name or a Map, None if it was not given. reading: the options for reading it.
    caller: a relative path is looked for beside this file, then in the current folder.
    """

    file: Any
    reading: dict[str, Any]
    caller: Path

    @classmethod
    def popped(cls, options: dict[str, Any], caller: Path) -> MapOption | None:
        """Take the option out of others; None if it is not among them."""
        names = [name for name in options if str(name).partition(".")[0] == "map"]
        given = {name: options.pop(name) for name in names}
        file, known = given.pop("map", None), [f"map.{name}" for name in reading_options()]
        for name in given:
            if name not in known:
                raise InputError(f"there is no option {name!r}{nearest(name, known)}")
        reading = {name.partition(".")[2]: value for name, value in given.items()}
        return cls(file, reading, caller) if names else None

    def value_for(self, default: Any) -> Any:
        """Return the value of a scenario function's parameter `map`, instead of its default."""
        found = self._replace(file=default if self.file is None else self.file)
        return found.map() if self.reading else found.file

    def map(self) -> Map:
        """Return the map. Raises InputError if it can't be read."""
        if isinstance(self.file, Map) and not self.reading:
            return self.file
        if self.file is None or isinstance(self.file, Map):
            raise InputError(f"map.{next(iter(self.reading))} needs map=FILE as well")
        if not isinstance(self.file, (str, Path)):
            raise wrong("map", self.file, "the name of a map's file, such as 'plan.dxf', or a Map")
        from mars2d.addons.maps import SUFFIXES

        file = file_beside(Path(self.file), self.caller, "a map", SUFFIXES)
        return Map.from_file(file.absolute(), **self.reading)

    def override(self, scenario: Scenario, options: Mapping[str, Any]) -> Scenario:
        """Return the scenario with the map instead of its own, and other options set.

        A workspace that is the default one, or smaller than the map, becomes the rectangle around
        the map. Raises InputError, which names free room, if a body would stand in a wall.
        """
        chart, rest = self.map(), dict(options)
        for name in reading_options():
            if name in rest:  # as mars2d check has it
                raise InputError(f"there is no option {name!r}; did you mean 'map.{name}'?")
        workspace = _workspace_for(scenario, chart)
        if "workspace" in rest:
            workspace = checks.optional(checks.outline, 3)(
                "Scenario.workspace", rest.pop("workspace")
            )
        own = next((addon for addon in scenario.addons if isinstance(addon, Map)), None)
        if own is not None:  # keep its name and surface
            chart = own.replace(outlines=chart.outlines, walls=chart.walls)
        others = [addon for addon in scenario.addons if not isinstance(addon, Map)]
        bare = override(scenario.replace(addons=others, workspace=None), rest)
        try:
            return bare.replace(addons=[*bare.addons, chart], workspace=workspace)
        except InputError as error:
            raise InputError(f"{error}{_room(bare, chart, workspace)}") from error


MARGIN = 1.0
"""The distance from a map's walls to the edge of a workspace made for it, metres."""

MAX_HINTS = 3
"""The number of bodies for which an error names free room."""

DEFAULT_WORKSPACE = Scenario.__dataclass_fields__["workspace"].default


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
    names = [
        f"{kind}.{k}" for kind in ("robots", "props") for k in range(len(vars(scenario)[kind]))
    ]
    hints: list[str] = []
    for name, body in zip(names, scenario.bodies, strict=True):
        center, radius = body.bound
        place = nearest_room(center, radius, outlines, workspace or within)
        if place is None:
            return f"; there is no room for {body.name} anywhere"
        if place == center:
            continue
        if len(hints) == MAX_HINTS:
            return f"; {', '.join(hints)}, and others have none where they stand"
        x, y = nearest_room(center, radius, outlines, within) or place  # indoors first
        outlines.append(rectangle(x - radius, x + radius, y - radius, y + radius))  # now taken
        x, y = x + body.pose[0] - center[0], y + body.pose[1] - center[1]
        hints.append(f"{body.name} has room at {name}.pose=({x:.3f}, {y:.3f}, {body.pose[2]:.4g})")
    return f"; {', '.join(hints)}" if hints else ""
