"""Experiments: opened from a file, a shipped example, a module or a Scenario."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any
from warnings import catch_warnings, simplefilter

from mars2d.core import checks
from mars2d.core.description import wrong
from mars2d.core.errors import InputError, LawError, Mars2dError, likely, nearest, shown
from mars2d.core.files import file_beside, files_read, note_file
from mars2d.core.hints import described
from mars2d.core.streams import check_seed
from mars2d.core.usercode import called, quiet
from mars2d.scenario import parameters, toml_file
from mars2d.scenario.code_file import law_in, line_in, module_in
from mars2d.scenario.examples import GAME, examples, experiment_name
from mars2d.scenario.options import override
from mars2d.scenario.parameters import PREFIX, Parameter
from mars2d.scenario.policy import SUFFIX
from mars2d.scenario.prediction import Prediction
from mars2d.scenario.scenario import Scenario


@dataclass(frozen=True)
class Source:
    """What a file says besides its scenario and its law.

    name: of the file, a game's with its folder, or of a module; "" for a Scenario. path: of the
    file, or None. summary: the first line of its docstring. checks: the function of the record that
    compares a run with theory, or None. function: that makes the scenario, or None. functions: its
    public ones by name. scopes: what a window plots at first: names of columns, and functions of
    the record, a number for each row. written: when it and the files that it read were written, ns.
    """

    name: str = ""
    path: Path | None = None
    summary: str = ""
    checks: Callable[[Any], Any] | None = None
    function: Callable[..., Any] | None = None
    functions: Mapping[str, Callable[..., Any]] = field(default_factory=dict)
    scopes: tuple[str | Callable[[Any], Any], ...] = ()
    written: Mapping[Path, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Experiment:
    """A scenario and the law of its team, as a file and options say.

    options, seed: with which it was opened. opened: opens it again with other options, or None.
    alone: whether its laws then share nothing with these, since its file is run again. plain: the
    experiment without those options that set fields and laws, if there are any.
    """

    scenario: Scenario
    control: Callable[[Any], Any] | None = None
    source: Source = field(default_factory=Source)
    options: Mapping[str, Any] = field(default_factory=dict)
    seed: int | None = None
    opened: Callable[[Mapping[str, Any]], Experiment] | None = None
    alone: bool = False
    plain: Experiment | None = None

    def reopened(self) -> Experiment:
        """Return the experiment opened again, or itself if it does not come from a file.

        Raises InputError, as `open_experiment` does, if the file has an error by now.
        """
        return self if self.opened is None or not self.alone else self.opened(self.options)

    def with_options(self, options: Mapping[str, Any]) -> Experiment:
        """Return the experiment opened again with these options, which replace those of before.

        Raises InputError, as `open_experiment` does.
        """
        if self.opened is None:
            return open_experiment(self.scenario, options, self.control, self.seed)
        return self.opened(options)

    def decides_as(self, other: Experiment) -> bool:
        """Return whether it has the same laws and add-ons, so far as can be told.

        They come from the same version of the same files, and their arguments are the same.
        """
        return (
            self.source.written == other.source.written
            and len(self._laws) == len(other._laws)
            and all(map(parameters.same, self._laws, other._laws))
            and self.scenario.addons == other.scenario.addons
        )

    def redrawn(self, scenario: Scenario, given: Collection[str | None] = ()) -> Experiment:
        """Return the experiment with another scenario; robots of the same names keep their laws.

        given: the names of robots that get the laws of `scenario` instead. Options that are set
        later change its fields and laws, but no parameters of a function.
        """
        laws = {r.name: r.controller for r in self.scenario.robots if r.name not in given}
        drawn = scenario.with_laws([laws.get(r.name, r.controller) for r in scenario.robots])

        def opened(options: Mapping[str, Any]) -> Experiment:
            of_scenario, of_laws = _split({k: v for k, v in options.items() if before.get(k) != v})
            again = self.with_options({**before, **of_laws}) if self.alone or of_laws else self
            again = again.redrawn(scenario, given)
            set_too = override(again.scenario, of_scenario)
            return replace(again, scenario=set_too, options=options, opened=opened, plain=again)

        before, source = self.options, replace(self.source, function=None)
        return replace(self, scenario=drawn, source=source, opened=opened, plain=None)

    def parameters(self, body: int | None = None) -> list[Parameter]:
        """Return the numbers that can be set: of the scenario function, and of laws.

        body: an index of `Scenario.bodies`, for the parameters of that robot or prop instead. An
        argument of a law is left out if the scenario function has one of its name, which sets it.
        """
        plain = self if self.plain is None else self.plain
        if body is not None:
            return [*parameters.of_body(self.scenario, plain.scenario, body)]
        made, given = self.source.function, self.options
        own = [] if made is None else [*parameters.of_arguments(made, given, self.seed)]
        names = {each.name for each in own}
        laws = parameters.of_laws(self._laws, plain._laws)
        return own + [each for each in laws if each.name.rpartition(".")[2] not in names]

    @property
    def _laws(self) -> list[Callable[[Any], Any] | None]:
        """The team's law, then those of the robots."""
        return [self.control, *(robot.controller for robot in self.scenario.robots)]

    def predictions(self, record: Any) -> tuple[Prediction, ...]:
        """Return the predictions that `checks` compares with a run; none without `checks`.

        There are none for a run that was cut short, has not a single step, or was changed by hand.
        Raises LawError, which points at file and line, if `checks` raises, or returns anything but
        predictions.
        """
        return tuple(self._checked(record)) if record.finished else ()

    def predictions_so_far(self, record: Any) -> tuple[tuple[Prediction, ...], LawError | None]:
        """Return the predictions for a run that goes on, and the error that ended `checks`, if any.

        `checks` may need what has not happened yet: what it returned before its error counts. What
        it prints, and what numpy warns of, is left out, as it would come again and again. There are
        no predictions for a run that has not a single step, or was changed by hand.
        """
        predictions: list[Prediction] = []
        try:
            with quiet(), catch_warnings():
                simplefilter("ignore")
                for prediction in self._checked(record):
                    predictions.append(prediction)  # noqa: PERF402 - those before an error count
        except LawError as error:
            return tuple(predictions), error
        return tuple(predictions), None

    def _checked(self, record: Any) -> Iterator[Prediction]:
        """Yield the predictions that `checks` makes of a record, if it can be compared."""
        checks = self.source.checks
        if checks is None or record.interventions or len(record) < 2:
            return
        expected = "expected a list of Prediction(name, predicted, measured, tolerance)"
        with called("checks", checks):
            made = checks(record)
            if isinstance(made, (str, bytes, Mapping)) or not isinstance(made, Iterable):
                found = "nothing" if made is None else shown(made)
                raise LawError(f"checks returned {found}: {expected}")
            for k, prediction in enumerate(made):  # which runs a generator
                if not isinstance(prediction, Prediction):
                    raise LawError(f"checks returned {shown(prediction)} as item {k}: {expected}")
                yield prediction


LISTED = "; mars2d list shows the examples"


def open_experiment(
    source: str | Path | ModuleType | Scenario,
    options: Mapping[str, Any] | None = None,
    control: Callable[[Any], Any] | None = None,
    seed: int | None = None,
) -> Experiment:
    """Return the experiment that `source` names, with its fields overridden by `options`.

    source: a file (.py, or .toml of a scenario), the name of a shipped example, a module, or a
    Scenario. options: values by dotted names of fields, by parameters of a scenario function, or
    by arguments of laws, for example ``laws.follow.gain``.
    control: the law of the team, instead of the experiment's own.
    seed: of the run. A scenario function with a parameter ``seed`` gets it unless the options set
    that, so that it can draw starts at random. Raises InputError, which points at file and line.
    """
    if options is not None and not isinstance(options, Mapping):
        raise wrong("options", options, "a dict, such as {'sampling_time': 0.5}")
    given, seed = dict(options or {}), None if seed is None else check_seed(seed)
    rest, of_laws = _split(given)
    with files_read() as files:
        plain = _opened(source, rest, control, seed)
        try:
            scenario = override(plain.scenario, rest)
            scenario = scenario if seed is None else scenario.started(seed)
            experiment = replace(plain, scenario=scenario)
            if of_laws:
                team, *own = parameters.laws_with(experiment._laws, of_laws)
                experiment = replace(plain, scenario=scenario.with_laws(own), control=team)
        except Mars2dError as error:
            error.where = error.where or plain.source.name or None
            raise
    read = files if control is None else ()
    written = {path: path.stat().st_mtime_ns for path in read if path.exists()}
    return replace(
        experiment,
        source=replace(experiment.source, written=written),
        options=given,
        seed=seed,
        opened=partial(open_experiment, source, control=control, seed=seed),
        alone=control is None and isinstance(source, (str, Path)),
        plain=None if scenario is plain.scenario and not of_laws else plain,
    )


def _split(options: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the options that are not of laws, and those that are."""
    of_laws = {name: value for name, value in options.items() if str(name).startswith(PREFIX)}
    return {name: value for name, value in options.items() if name not in of_laws}, of_laws


def _opened(
    source: str | Path | ModuleType | Scenario,
    options: dict[str, Any],
    control: Callable[[Any], Any] | None,
    seed: int | None,
) -> Experiment:
    """Return an experiment without fields set; what its scenario function takes is taken out."""
    if isinstance(source, Scenario):
        return Experiment(source, control)
    if not isinstance(source, (str, Path, ModuleType)):
        expected = "a file, the name of an example, or a Scenario"
        raise InputError(f"experiment = {shown(source)}: expected {expected}")
    path = None
    if isinstance(source, ModuleType):
        module = source
    else:
        path = _find(source)
        if path.suffix.lower() == ".toml":
            note_file(path)
            drawn, law = toml_file.read(path)
            return Experiment(drawn, control or law, Source(path.name, path.absolute()))
        module = module_in(path)
    file = Path(getattr(module, "__file__", None) or module.__name__)
    name = f"{experiment_name(file)}/{GAME}" if file.name == GAME else file.name
    try:
        scenario, function = _scenario_of(module, options, seed)
        own, check = getattr(module, "control", None), getattr(module, "checks", None)
        if any(robot.controller is own for robot in scenario.robots):
            own = None  # the law of robots is not that of their team
        if own is not None:
            checks.function("control", own, "the world")
        if check is not None:
            checks.function("checks", check, "the record")
        scopes = _scopes_of(module)
    except Mars2dError as error:
        error.where = error.where or name
        raise
    functions = {
        name: value for name, value in vars(module).items()
        if inspect.isfunction(value) and value.__module__ == module.__name__ and name[0] != "_"
    }  # fmt: skip
    summary = (module.__doc__ or "").strip().partition("\n")[0]
    path = None if path is None else path.absolute()
    said = Source(name, path, summary, check, function, functions, scopes)
    return Experiment(scenario, own if control is None else control, said)


def _scopes_of(module: ModuleType) -> tuple[str | Callable[[Any], Any], ...]:
    """Return the items of a module's list ``scopes``: names of columns, and functions."""
    expected = "a list of columns, such as 'speed', and functions of the record"
    scopes = tuple(checks.items_of("scopes", getattr(module, "scopes", ()), expected))
    for k, each in enumerate(scopes):
        if not isinstance(each, str):
            checks.function(f"scopes[{k}]", each, "the record")
    return scopes


def load_scenario(path: str | Path) -> Scenario:
    """Return the scenario in a .toml file, written by `save_scenario` or by hand.

    path: a relative path is looked for beside the file that calls this, then in the current folder.
    Raises InputError, which points at the line. The law of the team, if the file names one, is not
    part of a scenario: `mars2d.run` and `open_experiment` read it from the file.
    """
    if not isinstance(path, (str, Path)):
        raise wrong("load_scenario(path)", path, "the name of a file, such as 'room.toml'")
    caller = Path(sys._getframe(1).f_code.co_filename)
    return toml_file.read(file_beside(Path(path), caller, "a scenario", [toml_file.SUFFIX]))[0]


def open_module(source: str | Path) -> ModuleType:
    """Run a file, or the shipped example of that name, and return it as a module."""
    return module_in(_find(source))


def load_law(
    path: str | Path, name: str = "control", *arguments: Any, **values: Any
) -> Callable[[Any], Any]:
    """Return the law called `name` from a file: a function or generator of the robot.

    path: a relative path is looked for beside the file that calls this, then in the current folder.
    An ``.onnx`` file is a law that was learned, see `mars2d.rl`; it has neither name nor arguments.
    arguments, values: of the function, before the robot and by name, as for functools.partial. Each
    call runs the file again, so that robots with the same law share nothing. Raises InputError,
    which points at file and line.
    """
    if not isinstance(path, (str, Path)):
        raise wrong("load_law(path)", path, "the name of a law's file, such as 'my_law.py'")
    caller = Path(sys._getframe(1).f_code.co_filename)
    file = file_beside(Path(path), caller, "a law", [".py", SUFFIX])
    return law_in(file, name, "the robot or the world", (arguments, values))


def _find(source: str | Path) -> Path:
    path = Path(source)
    if path.is_file():
        return path
    known = examples()
    if str(source) in known:
        return known[str(source)]
    if path.exists():
        kind = "a folder" if path.is_dir() else "not a file"  # a pipe, which may never end
        expected = "an experiment, a file that ends in .py or .toml"
        meant = f"; did you mean {path / GAME}?" if (path / GAME).is_file() else ""
        raise InputError(f"{path}: {kind}; expected {expected}{meant}")
    files = path.parent.iterdir() if path.parent.is_dir() else ()
    beside = [str(file) for file in files if file.suffix in (".py", ".toml")]
    kind = "file" if path.suffix or len(path.parts) > 1 else "file or example"
    near = likely(source, [*beside, *known], 0.75)
    raise InputError(f"{source}: there is no such {kind}{near or LISTED}")


def _scenario_of(
    module: ModuleType, options: dict[str, Any], seed: int | None
) -> tuple[Scenario, Callable[..., Any] | None]:
    """Return a module's scenario, and its scenario function if it has one.

    Options that the function takes are taken out.
    """
    if not hasattr(module, "scenario"):
        meant = likely("scenario", {*vars(module)} - {"Scenario"})
        raise InputError(
            f"has no `scenario`: an experiment's file needs `scenario = Scenario(...)`{meant}"
        )
    scenario, function = module.scenario, None
    if callable(scenario) and not isinstance(scenario, (type, Scenario)):
        function, takes = scenario, inspect.signature(scenario).parameters
        if seed is not None and "seed" in takes:
            options.setdefault("seed", seed)
        scenario = _call_scenario(function, options)
    checks.instance(Scenario, "Scenario(robots=[...]), or a function of one")("scenario", scenario)
    return scenario, function


def _call_scenario(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """Call a scenario function with those of the options that are its parameters."""
    takes, numeric = inspect.signature(function).parameters, parameters.arguments_of(function)
    chosen = {name: options.pop(name) for name in list(options) if name in takes}
    known_fields = [f.name for f in fields(Scenario)]
    for name in options:
        if name.partition(".")[0] not in known_fields:
            raise InputError(f"there is no option {name!r}{nearest(name, [*takes, *known_fields])}")
    for name, p in takes.items():
        several = p.kind in (p.VAR_POSITIONAL, p.VAR_KEYWORD)
        if p.default is p.empty and name not in chosen and not several:
            raise InputError(
                f"scenario({', '.join(takes)}) needs {name!r}: give it a default, "
                f"or set it with --set {name}=..."
            )
    for name, value in chosen.items():
        if name in numeric:
            numeric[name].check(f"scenario({name})", value)
        elif isinstance(takes[name].default, bool) and isinstance(value, str):
            expected = f"True or False; its default is {takes[name].default}"
            raise wrong(f"scenario({name})", value, expected)
    try:
        return function(**chosen)
    except (Exception, SystemExit) as error:
        problem = error if isinstance(error, Mars2dError) else InputError(described(error))
        code = getattr(function, "__code__", None)
        if code is not None and problem.where is None:
            unsaid = {k: v for k, v in chosen.items() if str(v) not in str(problem)}
            given = "".join(f", with {name} = {shown(value)}" for name, value in unsaid.items())
            problem.where = f"{line_in(error, Path(code.co_filename))}{given}"
        raise problem from error
