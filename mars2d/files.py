"""Experiments: from a file, a shipped example, a module or a Scenario to what can be run."""

from __future__ import annotations

import ast
import dataclasses
import difflib
import importlib.util
import inspect
import itertools
import sys
import traceback
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, cast

from mars2d import checks
from mars2d.addons.map import Map
from mars2d.description import Description, wrong
from mars2d.errors import InputError, LawError, Mars2dError, described, nearest, shown
from mars2d.geometry import Outline, bounds_of
from mars2d.prediction import Prediction
from mars2d.scenario import Scenario
from mars2d.usercode import called, file_beside

if TYPE_CHECKING:
    from mars2d.record import Record

__all__ = [
    "Experiment",
    "examples",
    "load_law",
    "open_experiment",
    "open_module",
    "parse_setting",
]

_counter = itertools.count()


@dataclass(frozen=True)
class Experiment:
    """A scenario, the law of its team, and what its file says of it.

    filename: the file's name, or empty. checks: the function of the record that compares a run with
    theory, or None. summary: the first line of the file's docstring, or empty.
    """

    scenario: Scenario
    control: Callable[[Any], Any] | None = None
    filename: str = ""
    checks: Callable[[Any], Any] | None = None
    summary: str = ""

    def predictions(self, record: Record) -> tuple[Prediction, ...]:
        """Return what `checks` makes of a run; nothing without checks, or of a run cut short.

        Raises LawError, which points at file and line, where `checks` raises or returns anything
        but predictions.
        """
        if self.checks is None or not record.finished:
            return ()
        expected = "expected a list of Prediction(name, predicted, measured, tolerance)"
        with called("checks", self.checks):
            made = self.checks(record)
            if made is None:
                raise LawError(f"checks returned nothing: {expected}")
            if isinstance(made, (str, bytes, Mapping)) or not isinstance(made, Iterable):
                raise LawError(f"checks returned {shown(made)}: {expected}")
            predictions = tuple(made)  # which runs a generator
            for k, prediction in enumerate(predictions):
                if not isinstance(prediction, Prediction):
                    raise LawError(f"checks returned {shown(prediction)} as item {k}: {expected}")
        return predictions


def examples() -> dict[str, Path]:
    """Return the shipped examples: name to file."""
    package = Path(__file__).parent
    for folder in (package / "examples", package.parent / "examples"):  # a wheel's, a checkout's
        if folder.is_dir():
            files = sorted(folder.glob("*.py"))
            return {file.stem: file for file in files if not file.stem.startswith("_")}
    return {}


def open_experiment(
    source: str | Path | ModuleType | Scenario,
    options: Mapping[str, Any] | None = None,
    control: Callable[[Any], Any] | None = None,
) -> Experiment:
    """Return the experiment that `source` names, with its fields overridden by `options`.

    source: a file, the name of a shipped example, a module, or a Scenario. options: dotted names
    of fields, or keyword parameters of a scenario function, with their values; ``map`` is a file
    whose walls take the place of the experiment's, or a Map, and ``map.unit`` and the like are how
    it is read. control: the law of the team, in place of the experiment's own. Raises InputError,
    which points at file and line.
    """
    if options is not None and not isinstance(options, Mapping):
        raise wrong("options", options, "a dict, as {'sampling_time': 0.5}")
    options = dict(options or {})
    if isinstance(source, Scenario):
        chart = _MapOption.popped(options, Path())
        return Experiment(_override(source, options, chart), control)
    if isinstance(source, ModuleType):
        module, name = source, getattr(source, "__file__", None) or source.__name__
    elif isinstance(source, (str, Path)):
        path = _find(source)
        module, name = _load(path), str(path)
    else:
        raise InputError(
            f"experiment = {shown(source)}: expected a file, the name of an example, or a Scenario"
        )
    try:
        scenario = _scenario_of(module, options, Path(name))
        own = getattr(module, "control", None)
        if own is not None:
            checks.law("control", own, "the world")
        check = getattr(module, "checks", None)
        if check is not None:
            checks.law("checks", check, "the record")
    except Mars2dError as error:
        error.where = error.where or Path(name).name
        raise
    law = own if control is None else control
    summary = (module.__doc__ or "").strip().partition("\n")[0]
    return Experiment(scenario, law, Path(name).name, check, summary)


def open_module(source: str | Path) -> ModuleType:
    """Run a file, or the shipped example of that name, and return it as a module."""
    return _load(_find(source))


def load_law(path: str | Path, name: str = "control") -> Callable[[Any], Any]:
    """Return the law called `name` from a file of its own: a function or generator of the robot.

    path: a relative one is looked for beside the file that calls this, then in the current folder.
    Each call runs the file anew, so that robots with the same law share nothing. Raises InputError,
    which points at file and line.
    """
    if not isinstance(path, (str, Path)):
        raise wrong("load_law(path)", path, "the name of a law's file, as 'my_law.py'")
    if not isinstance(name, str):
        raise wrong("load_law(name)", name, "the name of a function, as 'control'")
    caller = Path(sys._getframe(1).f_code.co_filename)
    file = file_beside(Path(path), caller, "a law", [".py"])
    module = _load(file, "a law")
    try:
        return _law_of(module, name)
    except InputError as error:
        error.where = file.name
        raise


def _law_of(module: ModuleType, name: str) -> Callable[[Any], Any]:
    law = getattr(module, name, None)
    if law is None:
        functions = [key for key, value in vars(module).items() if inspect.isfunction(value)]
        raise InputError(f"has no law {name!r}{nearest(name, functions)}")
    checks.law(name, law, "the robot")
    return cast("Callable[[Any], Any]", law)


def _scripts(path: Path) -> list[Path]:
    """Return the Python files beside a path."""
    return [*path.parent.glob("*.py")] if path.parent.is_dir() else []


def _find(source: str | Path) -> Path:
    path = Path(source)
    if path.is_file():
        return path
    known = examples()
    if str(source) in known:
        return known[str(source)]
    if path.is_dir():
        raise InputError(f"{path}: a folder; expected an experiment, a file that ends in .py")
    beside = [str(file) for file in _scripts(path)]
    kind = "file" if path.suffix or len(path.parts) > 1 else "file or example"
    raise InputError(f"{source}: there is no such {kind}{nearest(source, [*beside, *known], 0.75)}")


def _load(path: Path, what: str = "an experiment") -> ModuleType:
    """Run a file as a module of its own, which no other one can see."""
    if path.suffix != ".py":
        raise InputError(f"{path}: expected {what}, a file that ends in .py")
    name = f"_mars2d_experiment_{next(_counter)}_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    before = set(sys.modules)
    sys.modules[name] = module  # dataclasses look a class's module up by its name
    folder = str(path.parent.absolute())
    sys.path.insert(0, folder)  # an experiment may import what lies beside it
    try:
        spec.loader.exec_module(module)
    except SyntaxError as error:
        problem = InputError(": ".join(filter(None, [error.msg, (error.text or "").strip()])))
        place = Path(error.filename or path).name
        problem.where = f"{place}, line {error.lineno}" if error.lineno else place
        raise problem from error
    except (Exception, SystemExit) as error:
        problem = InputError(described(error))
        problem.where = _line_in(error, path)
        raise problem from error
    finally:
        sys.path.remove(folder)
        _forget_modules(before, folder)
    return module


def _forget_modules(before: set[str], folder: str) -> None:
    """Forget the modules that came from a folder, so that another one's are not taken for them."""
    for name in set(sys.modules) - before:
        file = getattr(sys.modules[name], "__file__", None)
        if file is not None and str(Path(file).parent) == folder:
            del sys.modules[name]


def _line_in(error: BaseException, path: Path) -> str:
    """Return the place in `path` that an error passed through."""
    lines = [
        step.lineno
        for step in traceback.extract_tb(error.__traceback__)
        if Path(step.filename).absolute() == path.absolute()
    ]
    return f"{path.name}, line {lines[-1]}" if lines else path.name


def _scenario_of(module: ModuleType, options: dict[str, Any], path: Path) -> Scenario:
    """Return a module's scenario, made by its scenario function if it has one."""
    names = [name for name in vars(module) if not name.startswith("__")]
    if not hasattr(module, "scenario"):
        close = difflib.get_close_matches("scenario", set(names) - {"Scenario"}, n=1)
        hint = f"; it has a {close[0]!r}" if close else ""
        raise InputError(
            f"has no `scenario`: an experiment's file needs `scenario = Scenario(...)`{hint}"
        )
    scenario = module.scenario
    chart = _MapOption.popped(options, path)
    if callable(scenario) and not isinstance(scenario, Scenario):
        if chart is not None and "map" in inspect.signature(scenario).parameters:
            options["map"] = chart.value_for(inspect.signature(scenario).parameters["map"].default)
            chart = None
        scenario = _call_scenario(scenario, options)
    if not isinstance(scenario, Scenario):
        raise InputError(f"scenario = {shown(scenario)}: expected a Scenario, or a function of one")
    return _override(scenario, options, chart)


def _call_scenario(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """Call a scenario function with those of the options that are its parameters."""
    parameters = inspect.signature(function).parameters
    chosen = {name: options.pop(name) for name in list(options) if name in parameters}
    fields = {f.name for f in dataclasses.fields(Scenario)}
    for name in options:
        if name.partition(".")[0] not in fields:
            raise InputError(f"there is no option {name!r}{nearest(name, [*parameters, *fields])}")
    missing = [
        name
        for name, p in parameters.items()
        if p.default is p.empty
        and name not in chosen
        and p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)
    ]
    if missing:
        raise InputError(
            f"scenario({', '.join(parameters)}) needs {missing[0]!r}: give it a default, "
            f"or set it with --set {missing[0]}=..."
        )
    try:
        return function(**chosen)
    except (Exception, SystemExit) as error:
        problem = error if isinstance(error, Mars2dError) else InputError(described(error))
        code = getattr(function, "__code__", None)
        if code is not None:
            problem.where = problem.where or _line_in(error, Path(code.co_filename))
        raise problem from error


@dataclass(frozen=True)
class _MapOption:
    """The option ``map`` with how it is to be read, ``map.unit`` and the like.

    file: a file's name or a Map, None if it was not given. caller: a relative name is looked for
    beside this file, then in the current folder.
    """

    file: Any
    settings: dict[str, Any]
    caller: Path

    @classmethod
    def popped(cls, options: dict[str, Any], caller: Path) -> _MapOption | None:
        """Take the option out of others; None if it is not among them."""
        names = [name for name in options if str(name).partition(".")[0] == "map"]
        if not names:
            return None
        given = {name: options.pop(name) for name in names}
        file = given.pop("map", None)
        known = [n for n in inspect.signature(Map.from_file).parameters if n != "path"]
        settings = {name.partition(".")[2]: value for name, value in given.items()}
        for name in settings:
            if name not in known:
                raise InputError(f"there is no option 'map.{name}'{nearest(name, known)}")
        return cls(file, settings, caller)

    def value_for(self, default: Any) -> Any:
        """Return what a scenario function's parameter `map` gets, in place of its default."""
        file = default if self.file is None else self.file
        return _MapOption(file, self.settings, self.caller).map() if self.settings else file

    def map(self) -> Map:
        """Return the map. Raises InputError if it can't be read."""
        if isinstance(self.file, Map) and not self.settings:
            return self.file
        if not isinstance(self.file, (str, Path)):
            if self.file is None or isinstance(self.file, Map):
                raise InputError(f"map.{next(iter(self.settings))} needs map=FILE as well")
            raise wrong("map", self.file, "the name of a map's file, as 'plan.dxf', or a Map")
        from mars2d.maps import SUFFIXES

        file = file_beside(Path(self.file), self.caller, "a map", SUFFIXES)
        return Map.from_file(file.absolute(), **self.settings)


MARGIN = 1.0
"""From a map's walls to the edge of a workspace that is made for it, metres."""

OPEN = Scenario.__dataclass_fields__["workspace"].default


def _with_map(scenario: Scenario, options: Mapping[str, Any], chart: Map) -> Scenario:
    """Return the scenario with a map in place of its own, and the options set.

    A workspace that is the default one, or smaller than the map, becomes the rectangle round it.
    """
    rest = dict(options)
    workspace = _workspace_for(scenario, chart)
    if "workspace" in rest:
        workspace = rest.pop("workspace")
        if workspace is not None:
            workspace = checks.outline("Scenario.workspace", workspace, least=3)
    own = next((addon for addon in scenario.addons if isinstance(addon, Map)), None)
    if own is not None:  # keep its name and surface
        chart = own.replace(outlines=chart.outlines, walls=chart.walls)
    others = [addon for addon in scenario.addons if not isinstance(addon, Map)]
    bare = _override(scenario.replace(addons=others, workspace=None), rest)
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
    if within and scenario.workspace != OPEN:
        return scenario.workspace
    return _rectangle(xmin - MARGIN, xmax + MARGIN, ymin - MARGIN, ymax + MARGIN)


def _rectangle(xmin: float, xmax: float, ymin: float, ymax: float) -> Outline:
    return ((xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax))


def _room(scenario: Scenario, chart: Map, workspace: Outline | None) -> str:
    """Return where the first body that stands in a wall, or outside, would have room."""
    from mars2d.maps import nearest_room

    outlines = chart.obstacles()
    within = _rectangle(*bounds_of([p for o in outlines for p in o]))
    for i, body in enumerate(scenario.bodies):
        center, radius = body.bound
        place = nearest_room(center, radius, outlines, workspace or within)
        if place is None:
            return f"; there is no room for {body.name} anywhere"
        if place != center:
            place = nearest_room(center, radius, outlines, within) or place  # indoors first
            x, y, theta = body.pose
            x, y = x + place[0] - center[0], y + place[1] - center[1]
            kind, k = ("robots", i) if i < len(scenario.robots) else ("props", i)
            k -= 0 if kind == "robots" else len(scenario.robots)
            there = f"({x:.3f}, {y:.3f}, {theta:.4g})"
            return f"; {body.name} has room at {kind}.{k}.pose={there}"
    return ""


def _override(
    scenario: Scenario, options: Mapping[str, Any], chart: _MapOption | None = None
) -> Scenario:
    """Return the scenario with all options set at once: they are only checked together."""
    if chart is not None:
        return _with_map(scenario, options, chart.map())
    tree: dict[str, Any] = {}
    for name, value in options.items():
        *path, last = str(name).split(".")
        branch = tree
        for part in path:
            branch = branch.setdefault(part, {})
            if not isinstance(branch, dict):
                raise InputError(f"the options set {part!r} and a field of it, in {name!r}")
        branch[last] = _Leaf(value)
    return scenario if not tree else _replaced(scenario, tree, ())


class _Leaf:
    """A value that an option sets, at the end of its path."""

    def __init__(self, value: Any) -> None:
        self.value = value


def _replaced(target: Any, tree: Any, path: tuple[str, ...]) -> Any:
    """Return `target` with its fields set as the tree says; ``*`` is all items of a list."""
    if isinstance(tree, _Leaf):
        return tree.value
    if isinstance(target, tuple):
        items = list(target)
        for part, branch in tree.items():
            chosen = range(len(items)) if part == "*" else [_index(part, len(items), path)]
            for i in chosen:
                items[i] = _replaced(items[i], branch, (*path, part))
        return tuple(items)
    if isinstance(target, Description):
        fields = [f.name for f in dataclasses.fields(target)]
        for part in tree:
            if part not in fields:
                raise InputError(
                    f"there is no option {'.'.join((*path, part))!r}: {type(target).__name__} has "
                    f"no field {part!r}{nearest(part, fields)}"
                )
        changes = {
            part: _replaced(getattr(target, part), branch, (*path, part))
            for part, branch in tree.items()
        }
        return target.replace(**changes)
    option = ".".join((*path, next(iter(tree))))
    raise InputError(f"there is no option {option!r}: {shown(target)} has no fields")


def _index(text: str, length: int, path: tuple[str, ...]) -> int:
    if not text.isdigit() or int(text) >= length:
        option = ".".join((*path, text))
        raise InputError(
            f"there is no option {option!r}: expected * or 0 to {length - 1}, not {text!r}"
        )
    return int(text)


def parse_setting(text: str) -> tuple[str, Any]:
    """Return (name, value) of a setting ``name=value`` from the command line.

    The value is a Python literal, as ``0.5``, ``True`` or ``(1, 2)``; anything else is text.
    """
    name, equals, value = text.partition("=")
    if not equals or not name.strip():
        raise InputError(f"--set {text}: expected NAME=VALUE, as --set sampling_time=0.5")
    try:
        return name.strip(), ast.literal_eval(value.strip())
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return name.strip(), value.strip()
