"""Check all parts and laws that a file defines, as its scenario uses them."""

from __future__ import annotations

import contextlib
import dataclasses
import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from types import ModuleType
from typing import Any

from mars2d.addons.base import Addon
from mars2d.bodies.drives.base import Drive
from mars2d.core.deadline import Deadline
from mars2d.core.description import Description
from mars2d.core.errors import InputError
from mars2d.core.usercode import name_of
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.addon import addon_findings
from mars2d.testing.controller import controller_findings, is_of_a_team
from mars2d.testing.drive import drive_findings
from mars2d.testing.finding import Finding
from mars2d.testing.sensor import sensor_findings

FAMILIES: dict[str, type[Description]] = {"drive": Drive, "sensor": Sensor, "add-on": Addon}

MAX_OBJECTS = 3
"""How many different objects of one class in a scenario are tried, at most."""


@dataclass(frozen=True)
class Case:
    """A part or law to be tried: its name, where it is tried, and the function that tries it.

    untried: why it can't be tried; then `findings` returns nothing.
    """

    name: str
    where: str
    findings: Callable[[], tuple[Finding, ...]] = tuple
    untried: str = ""


def defined_parts(module: ModuleType) -> dict[str, list[type[Description]]]:
    """Return the classes of parts that a file defines, by family."""
    found: dict[str, list[type[Description]]] = {family: [] for family in FAMILIES}
    kinds = [k for k in vars(module).values() if isinstance(k, type)]
    own = [k for k in kinds if k.__module__ == module.__name__ and issubclass(k, Description)]
    mine = list(dict.fromkeys(own))
    for kind in mine:
        derived = any(other is not kind and issubclass(other, kind) for other in mine)
        for family, base in FAMILIES.items():
            if issubclass(kind, base) and not (derived and _is_abstract(kind, base)):
                found[family].append(kind)
    return found


def _is_abstract(kind: type[Description], base: type[Description]) -> bool:
    """Return whether a class lacks the method that each part of its family must have."""
    needed = {Sensor: "read", Drive: "twist"}.get(base, "")
    return bool(needed) and getattr(kind, needed) is getattr(base, needed)


def trials(
    module: ModuleType, experiment: Experiment | None, deadline: Deadline | None = None
) -> Iterator[Case]:
    """Yield everything in a file that can be tried: drives, sensors and add-ons, then laws.

    experiment: the file's own, or None if it has no scenario.
    """
    defined = defined_parts(module)
    for family, kinds in defined.items():
        for kind in kinds:
            yield from _of_class(family, kind, experiment, deadline)
    if experiment is not None:
        yield from _of_experiment(experiment, deadline)
    else:
        yield from _of_laws(module, _all_that_can_be_made(defined["sensor"]), deadline)


def _of_class(
    family: str, kind: type[Description], experiment: Experiment | None, deadline: Deadline | None
) -> Iterator[Case]:
    name = f"{family} {kind.__name__}"
    scenario = None if experiment is None else experiment.scenario
    used = [] if scenario is None else [p for p in _parts(scenario)[family] if type(p) is kind]
    if used and experiment is not None:
        for part in used[:MAX_OBJECTS]:
            yield _trial(
                name if len(used) == 1 else f"{family} {part!r}", part, experiment, deadline
            )
        return
    required = _required(kind)
    if required:
        verb = "has no default" if len(required) == 1 else "have no defaults"
        fields = " and ".join(f"{kind.__name__}.{field}" for field in required)
        where = "the file has no scenario" if scenario is None else "no object is in the scenario"
        yield Case(name, "", untried=f"not tried: {fields} {verb}, and {where}")
        return
    try:
        part = kind()
    except InputError as error:
        yield Case(name, "", _saying(f"{kind.__name__}() has defaults that it refuses: {error}"))
        return
    yield _trial(name, part, None, deadline)


def _trial(name: str, part: Any, experiment: Experiment | None, deadline: Deadline | None) -> Case:
    """Return the trial of a part, in the file's own scenario if there is one."""
    if isinstance(part, Drive):
        return Case(name, "in a small world", partial(drive_findings, part, deadline=deadline))
    findings = sensor_findings if isinstance(part, Sensor) else addon_findings
    if experiment is None:
        return Case(name, "in a small world", partial(findings, part, deadline=deadline))
    scenario, control = experiment.scenario, experiment.control
    trial = partial(findings, part, scenario=scenario, control=control, deadline=deadline)
    return Case(name, "in its scenario", trial)


def _of_experiment(experiment: Experiment, deadline: Deadline | None) -> Iterator[Case]:
    """Yield the laws of a scenario; equal code is tried once."""
    scenario, control = experiment.scenario, experiment.control
    laws: dict[Any, tuple[Callable[[Any], Any], list[str]]] = {}
    for robot in scenario.robots:
        law = robot.controller
        if law is not None:
            code = getattr(inspect.unwrap(law), "__code__", law)
            laws.setdefault(code, (law, []))[1].append(str(robot.name))
    trial = partial(controller_findings, scenario=scenario, deadline=deadline)
    if control is not None:
        yield Case(f"law {name_of(control)}", "of the team", partial(trial, control, team=True))
    for law, robots in laws.values():
        yield Case(
            f"law {name_of(law)}",
            f"of {', '.join(robots[:3])}{', ...' if len(robots) > 3 else ''}",
            partial(trial, law, control=control, team=False),
        )


def _of_laws(module: ModuleType, sensors: list[Any], deadline: Deadline | None) -> Iterator[Case]:
    """Yield the laws of a file without a scenario: `control`, and functions of a robot or world."""
    for name, function in list(vars(module).items()):
        if not inspect.isfunction(function) or function.__module__ != module.__name__:
            continue
        arguments = list(inspect.signature(function).parameters)
        if name == "control" or (arguments in (["robot"], ["world"]) and not name.startswith("_")):
            where = "of a team" if is_of_a_team(function) else "of a robot"
            trial = partial(controller_findings, function, sensors=sensors, deadline=deadline)
            yield Case(f"law {name}", f"{where}, in a small world", trial)


def _all_that_can_be_made(kinds: list[type[Description]]) -> list[Any]:
    """Return an object of each class that has no required fields and is complete."""
    made = []
    for kind in kinds:
        if not (_required(kind) or _is_abstract(kind, Sensor)):
            with contextlib.suppress(InputError):  # reported where the class is tried
                made.append(kind())
    return made


def _saying(text: str) -> Callable[[], tuple[Finding, ...]]:
    return lambda: (Finding("wrong", text),)


def _parts(scenario: Scenario) -> dict[str, list[Any]]:
    """Return the different parts of a scenario by family."""
    found: dict[str, list[Any]] = {
        "sensor": [sensor for robot in scenario.robots for sensor in robot.sensors],
        "add-on": list(scenario.addons),
        "drive": [robot.drive for robot in scenario.robots],
    }
    return {family: _different(parts) for family, parts in found.items()}


def _different(parts: list[Any]) -> list[Any]:
    kept: list[Any] = []
    for part in parts:
        if not any(part is other or _equal(part, other) for other in kept):
            kept.append(part)
    return kept


def _equal(one: Any, other: Any) -> bool:
    try:
        return bool(one == other)
    except ValueError:  # an array in a field
        return False


def _required(kind: type[Description]) -> list[str]:
    missing = dataclasses.MISSING
    return [
        field.name
        for field in dataclasses.fields(kind)
        if field.init and field.default is missing and field.default_factory is missing
    ]
