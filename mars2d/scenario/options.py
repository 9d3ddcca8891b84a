"""Options: other values for fields of a scenario, by dotted names, and another map."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from mars2d.addons.map import Map
from mars2d.core import checks
from mars2d.core.description import Description, wrong
from mars2d.core.errors import InputError, nearest, one_line, shown
from mars2d.core.files import file_beside
from mars2d.core.plane import Outline, bounds_of, rectangle
from mars2d.scenario.scenario import Scenario

MARGIN = 1.0
"""The distance from a map's walls to the edge of a workspace made for it, metres."""

DEFAULT_WORKSPACE = Scenario.__dataclass_fields__["workspace"].default


def override(scenario: Scenario, options: Mapping[str, Any]) -> Scenario:
    """Return the scenario with all options set at once, so that they are checked together.

    options: values by dotted names, such as ``robots.*.diameter``. Raises InputError for unknown
    names.
    """
    found = _replaced(scenario, {str(name): value for name, value in options.items()}, "")
    assert isinstance(found, Scenario)
    return found


def _replaced(target: Any, options: Mapping[str, Any], path: str) -> Any:
    """Return a part with the options set, by names within it; ``*`` means all items of a list.

    path: its own name and a full stop; empty for the scenario.
    """
    option = path + next(iter(options), "")
    if "" in options:  # the part itself
        value = options[""]
        if len(options) > 1:
            raise InputError(f"the options set {path[:-1]!r}, and a field of it as well")
        if isinstance(target, Description) and isinstance(value, str):
            raise InputError(
                f"{path[:-1]} = {value!r}: an option is a number, a word or a tuple; write "
                f"{value} in the file, or set single fields, such as {path}FIELD=..."
            )
        return value
    inside: dict[str, dict[str, Any]] = {}
    for name, value in options.items():
        first, _, rest = name.partition(".")
        inside.setdefault(first, {})[rest] = value
    if isinstance(target, tuple):
        items = list(target)
        for name, given in inside.items():
            if name == "*" and not items:
                raise InputError(f"there is no option {option!r}: this scenario has no {path[:-1]}")
            for i in range(len(items)) if name == "*" else [_index(name, items, path)]:
                items[i] = _replaced(items[i], given, f"{path}{name}.")
        return tuple(items)
    if not isinstance(target, Description):
        raise InputError(f"there is no option {option!r}: {shown(target)} has no fields")
    for name in inside:
        if name not in target.__dataclass_fields__:
            raise InputError(
                f"there is no option {path + name!r}: {type(target).__name__} has "
                f"no field {name!r}{target.meant(name)}"
            )
    changes = {
        name: _replaced(getattr(target, name), given, f"{path}{name}.")
        for name, given in inside.items()
    }
    return target.replace(**changes) if changes else target


def _index(text: str, items: Sequence[Any], path: str) -> int:
    """Return the index of an item by its number or its name, the one that laws use."""
    names = [str(getattr(item, "key", None) or getattr(item, "name", "")) for item in items]
    if text in names:
        return names.index(text)
    if not text.isdigit() or int(text) >= len(items):
        named = f" or a name{nearest(text, filter(None, names))}" if any(names) else ""
        expected = f"expected * or 0 to {len(items) - 1}{named}"
        raise InputError(f"there is no option {path + text!r}: {expected}")
    return int(text)


def options_in_words(options: Mapping[str, Any]) -> str:
    """Return options in one line.

    >>> options_in_words({"mu": 0.3, "laws.follow.gain": 2})
    'mu = 0.3, laws.follow.gain = 2'
    """
    return one_line(", ".join(f"{name} = {shown(value)}" for name, value in options.items()))


def parse_option(text: str) -> tuple[str, Any]:
    """Return (name, value) of a setting ``name=value`` from the command line.

    The value is a Python literal, such as ``0.5``, ``True`` or ``(1, 2)``; anything else is text.
    """
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise InputError(f"--set {text}: expected NAME=VALUE, such as --set sampling_time=0.5")
    try:
        return name.strip(), ast.literal_eval(value.strip())
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return name.strip(), value.strip()


def reading_options() -> list[str]:
    """Return the names of the options for reading a map, such as ``unit``."""
    return [name for name in inspect.signature(Map.from_file).parameters if name != "path"]


def popped_map(options: dict[str, Any], caller: Path, default: Any = None) -> Any:
    """Take the option ``map`` out of others, with those for reading it, such as ``map.unit``.

    Returns its value, or the default; the Map itself if there are options for reading it. caller:
    see `map_in`.
    """
    known = [f"map.{name}" for name in reading_options()]
    reading = {}
    for name in [name for name in options if str(name).startswith("map.")]:
        if name not in known:
            raise InputError(f"there is no option {name!r}{nearest(name, known)}")
        reading[name.partition(".")[2]] = options.pop(name)
    file = options.pop("map", default)
    return map_in(file, caller, reading) if reading else file


def map_in(file: Any, caller: Path, reading: Mapping[str, Any] = MappingProxyType({})) -> Map:
    """Return the map in a file, or a Map itself. Raises InputError if it can't be read.

    caller: a relative path is looked for beside this file, then in the current folder.
    """
    if isinstance(file, Map) and not reading:
        return file
    if file is None or isinstance(file, Map):
        raise InputError(f"map.{next(iter(reading))} needs map=FILE as well")
    if not isinstance(file, (str, Path)):
        raise wrong("map", file, "the name of a map's file, such as 'plan.dxf', or a Map")
    from mars2d.addons.maps import SUFFIXES

    return Map.from_file(file_beside(Path(file), caller, "a map", SUFFIXES).absolute(), **reading)


def with_map(scenario: Scenario, chart: Map, options: Mapping[str, Any]) -> Scenario:
    """Return the scenario with a map instead of its own, and other options set.

    A workspace that is the default one, or smaller than the map, becomes the rectangle around the
    map. Raises InputError if a body would stand in a wall.
    """
    rest = dict(options)
    for name in reading_options():
        if name in rest:  # as mars2d check has it
            raise InputError(f"there is no option {name!r}; did you mean 'map.{name}'?")
    workspace = _workspace_for(scenario, chart)
    if "workspace" in rest:
        given = rest.pop("workspace")
        workspace = checks.optional(checks.outline, 3)("Scenario.workspace", given)
    own = next((addon for addon in scenario.addons if isinstance(addon, Map)), None)
    if own is not None:  # keep its name and surface
        chart = own.replace(outlines=chart.outlines, walls=chart.walls)
    others = [addon for addon in scenario.addons if not isinstance(addon, Map)]
    bare = override(scenario.replace(addons=others, workspace=None), rest)
    return bare.replace(addons=[*bare.addons, chart], workspace=workspace)


def _workspace_for(scenario: Scenario, chart: Map) -> Outline | None:
    if scenario.workspace is None or not chart.obstacles():
        return scenario.workspace
    xmin, xmax, ymin, ymax = bounds_of([p for o in chart.obstacles() for p in o])
    left, right, low, high = bounds_of(scenario.workspace)
    within = left <= xmin and xmax <= right and low <= ymin and ymax <= high
    if within and scenario.workspace != DEFAULT_WORKSPACE:
        return scenario.workspace
    return rectangle(xmin - MARGIN, xmax + MARGIN, ymin - MARGIN, ymax + MARGIN)
