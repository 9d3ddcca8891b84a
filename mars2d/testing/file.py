"""Check all parts and laws that a file defines, as its scenario uses them."""

from __future__ import annotations

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
from mars2d.core.usercode import name_of
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.addon import addon_findings
from mars2d.testing.controller import controller_findings, is_of_a_team
from mars2d.testing.drive import drive_findings
from mars2d.testing.finding import Finding
from mars2d.testing.sensor import sensor_findings

FAMILIES: tuple[tuple[str, type[Description], str], ...] = (
    ("drive", Drive, "twist"),
    ("sensor", Sensor, "read"),
    ("add-on", Addon, ""),
)
"""The families of parts: name, base, and the method that each of them must have."""

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


def trials(
    module: ModuleType, experiment: Experiment | None, deadline: Deadline | None = None
) -> Iterator[Case]:
    """Yield everything in a file that can be tried: drives, sensors and add-ons, then laws.

    experiment: the file's own, or None if it has no scenario.
    """
    kinds = [k for k in vars(module).values() if isinstance(k, type) and issubclass(k, Description)]
    own = [kind for kind in dict.fromkeys(kinds) if kind.__module__ == module.__name__]
    sensors: list[Sensor] = []
    for family, base, method in FAMILIES:
        for kind in own:
            lacks = method and getattr(kind, method, None) is getattr(base, method)
            derived = any(other is not kind and issubclass(other, kind) for other in own)
            if issubclass(kind, base) and not (lacks and derived):
                yield from _of_class(f"{family} {kind.__name__}", kind, experiment, deadline)
                if issubclass(kind, Sensor) and not (lacks or _required(kind)):
                    sensors.append(kind())
    if experiment is not None:
        yield from _of_experiment(experiment, deadline)
        return
    for name, function in list(vars(module).items()):
        if inspect.isfunction(function) and function.__module__ == module.__name__:
            arguments = list(inspect.signature(function).parameters)
            if name == "control" or (arguments in (["robot"], ["world"]) and name[0] != "_"):
                where = "of a team" if is_of_a_team(function) else "of a robot"
                trial = partial(controller_findings, function, sensors=sensors, deadline=deadline)
                yield Case(f"law {name}", f"{where}, in a small world", trial)


def _of_class(
    name: str, kind: type[Description], experiment: Experiment | None, deadline: Deadline | None
) -> Iterator[Case]:
    """Yield the trials of the objects of a class in the scenario, or of one with its defaults."""
    parts = [] if experiment is None else _parts(experiment.scenario)
    used = list({repr(part): part for part in parts if type(part) is kind}.values())
    for part in used[:MAX_OBJECTS]:
        title = name if len(used) == 1 else f"{name.partition(' ')[0]} {part!r}"
        yield _trial(title, part, experiment, deadline)
    if used:
        return
    required = _required(kind)
    if required:
        verb = "has no default" if len(required) == 1 else "have no defaults"
        fields = " and ".join(f"{kind.__name__}.{field}" for field in required)
        where = "no object is in the scenario" if experiment else "the file has no scenario"
        yield Case(name, "", untried=f"not tried: {fields} {verb}, and {where}")
        return
    yield _trial(name, kind(), None, deadline)


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
    trial = partial(controller_findings, scenario=scenario, deadline=deadline)
    if control is not None:
        yield Case(f"law {name_of(control)}", "of the team", partial(trial, control, team=True))
    laws: dict[Any, tuple[Callable[[Any], Any], list[str]]] = {}
    for robot in scenario.robots:
        law = robot.controller
        if law is not None:
            code = getattr(inspect.unwrap(law), "__code__", law)
            laws.setdefault(code, (law, []))[1].append(str(robot.name))
    for law, robots in laws.values():
        where = f"of {', '.join(robots[:3])}{', ...' if len(robots) > 3 else ''}"
        yield Case(f"law {name_of(law)}", where, partial(trial, law, control=control, team=False))


def _parts(scenario: Scenario) -> list[Any]:
    """Return the parts of a scenario that can be tried."""
    sensors = [sensor for robot in scenario.robots for sensor in robot.sensors]
    return [*(robot.drive for robot in scenario.robots), *sensors, *scenario.addons]


def _required(kind: type[Description]) -> list[str]:
    missing = dataclasses.MISSING
    return [
        field.name
        for field in dataclasses.fields(kind)
        if field.init and field.default is missing and field.default_factory is missing
    ]
