"""Check all parts and laws that a file defines, as its scenario uses them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from types import ModuleType
from typing import Any

from mars2d.addons.base import Addon
from mars2d.core.deadline import Deadline
from mars2d.core.description import Description
from mars2d.core.errors import InputError
from mars2d.core.usercode import name_of
from mars2d.scenario.experiment import Experiment
from mars2d.sensors.base import Sensor
from mars2d.testing.addon import check_addon
from mars2d.testing.controller import check_controller, code_of, is_of_a_team
from mars2d.testing.sensor import check_sensor
from mars2d.testing.subject import CheckError, Finding

FAMILIES: tuple[tuple[str, type[Description], str, Callable[..., None]], ...] = (
    ("sensor", Sensor, "read", check_sensor),
    ("add-on", Addon, "", check_addon),
)
"""The families of parts: name, base, the method that each must have, and what checks it."""

MAX_OBJECTS = 3
"""How many different objects of one class in a scenario are tried, at most."""


@dataclass(frozen=True)
class Case:
    """A part or law to be tried: its name, where it is tried, and the checker of it.

    untried: why it can't be tried; then `findings` returns nothing.
    """

    name: str
    where: str
    check: Callable[[], None] = lambda: None
    untried: str = ""

    def findings(self) -> tuple[Finding, ...]:
        """Try it, and return what is wrong."""
        try:
            self.check()
        except CheckError as error:
            return error.findings
        return ()


def trials(
    module: ModuleType, experiment: Experiment | None, deadline: Deadline | None = None
) -> Iterator[Case]:
    """Yield everything in a file that can be tried: sensors and add-ons, then laws.

    experiment: the file's own, or None if it has no scenario.
    """
    kinds = [k for k in vars(module).values() if isinstance(k, type) and issubclass(k, Description)]
    own = [kind for kind in dict.fromkeys(kinds) if kind.__module__ == module.__name__]
    sensors: list[Sensor] = []
    for family, base, method, check in FAMILIES:
        for kind in own:
            lacks = method and getattr(kind, method, None) is getattr(base, method)
            derived = any(other is not kind and issubclass(other, kind) for other in own)
            if issubclass(kind, base) and not (lacks and derived):
                yield from _of_class(family, kind, experiment, partial(check, deadline=deadline))
                if issubclass(kind, Sensor) and not lacks:
                    with suppress(InputError):  # of a field without a default
                        sensors.append(kind())
    if experiment is not None:
        yield from _of_experiment(experiment, deadline)
        return
    for name, function in list(vars(module).items()):
        if inspect.isfunction(function) and function.__module__ == module.__name__:
            arguments = list(inspect.signature(function).parameters)
            if name == "control" or (arguments in (["robot"], ["world"]) and name[0] != "_"):
                where = "of a team" if is_of_a_team(function) else "of a robot"
                trial = partial(check_controller, function, sensors=sensors, deadline=deadline)
                yield Case(f"law {name}", f"{where}, in a small world", trial)


def _of_class(
    family: str,
    kind: type[Description],
    experiment: Experiment | None,
    check: Callable[..., None],
) -> Iterator[Case]:
    """Yield the trials of the objects of a class in the scenario, or of one with its defaults."""
    name, used, inside = f"{family} {kind.__name__}", {}, check
    if experiment is not None:
        scenario = experiment.scenario
        parts = [sensor for robot in scenario.robots for sensor in robot.sensors]
        used = {repr(each): each for each in (*parts, *scenario.addons) if type(each) is kind}
        inside = partial(check, scenario=scenario, control=experiment.control)
    for part in list(used.values())[:MAX_OBJECTS]:
        title = name if len(used) == 1 else f"{family} {part!r}"
        yield Case(title, "in its scenario", partial(inside, part))
    if used:
        return
    try:
        yield Case(name, "in a small world", partial(check, kind()))
    except InputError as error:
        yield Case(name, "", untried=f"not tried, since no object is in a scenario: {error}")


def _of_experiment(experiment: Experiment, deadline: Deadline | None) -> Iterator[Case]:
    """Yield the laws of a scenario; equal code is tried once."""
    scenario, control = experiment.scenario, experiment.control
    trial = partial(check_controller, scenario=scenario, deadline=deadline)
    if control is not None:
        yield Case(f"law {name_of(control)}", "of the team", partial(trial, control, team=True))
    laws: dict[Any, tuple[Callable[[Any], Any], list[str]]] = {}
    for robot in scenario.robots:
        law = robot.controller
        if law is not None:
            laws.setdefault(code_of(law), (law, []))[1].append(str(robot.name))
    for law, robots in laws.values():
        where = f"of {', '.join(robots[:3])}{', ...' if len(robots) > 3 else ''}"
        yield Case(f"law {name_of(law)}", where, partial(trial, law, control=control, team=False))
