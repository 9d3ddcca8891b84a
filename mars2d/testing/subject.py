"""What is on trial, and the checks for all kinds of parts: arguments, fields, repeatability."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import json
import pickle
import random
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TypeVar

import numpy as np

from mars2d.core.deadline import Deadline
from mars2d.core.description import Description
from mars2d.core.errors import InputError, UnknownNameError, likely, shown
from mars2d.core.hints import described
from mars2d.core.scene import Scene
from mars2d.scenario import serialize
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.sensing import Sense
from mars2d.testing.finding import Report
from mars2d.testing.trial import Run, Trial, contents, difference
from mars2d.world.world import World

Part = TypeVar("Part", bound=Description)

ControlLaw = Callable[[Any], Any]

KEEP = "Keep things in attributes of self, set in on_start"

Placed = tuple[Scenario, ControlLaw | None]
"""A scenario, and the law of its team."""


class Subject:
    """A part or law on trial, and what has been found.

    name: of the class or function. label: how else than by its name the errors begin for which it
    is responsible. stream: the random generator that it should use, in words. keep: where it should
    keep things, as a sentence. tried: whether the first run is over; others are only compared.
    """

    def __init__(self, name: str, stream: str, keep: str = KEEP, label: str = "") -> None:
        self.name, self.stream, self.keep = name, stream, keep
        self.labels = tuple(filter(None, (f"{name} ", f"{name}.", label)))
        self.report = Report()
        self.shares = self.tried = False

    @contextmanager
    def calling(self, where: str) -> Iterator[None]:
        """Report if a call draws from a random generator that all of Python shares."""
        before = _shared_states()
        try:
            yield
        finally:
            for generator, state in _shared_states().items():
                if state != before[generator]:
                    self.shares = True
                    self.report.wrong(
                        f"{where} draws from {generator}, which all of Python shares: the same "
                        f"seed would not give the same run; draw from {self.stream}"
                    )

    def first_run(
        self,
        place: Callable[[], Placed],
        limit: Deadline,
        look: Callable[[World], None] = lambda _: None,
        *,
        small: bool,
    ) -> tuple[Trial, Run] | None:
        """Run for the first time; return None, after reporting why, if the run breaks down.

        place: returns a scenario with the part or law in it, and the law of its team. small:
        whether that is the small world, in which nothing else can fail.
        """
        trial = Trial(self.name, lambda seed: World(*place(), seed), limit)
        run = trial.run(look)
        self.tried = True
        if run.error is None:
            return trial, run
        if small and _asks_for_a_sensor(run.error):
            self.report.wrong(
                f"{run.error}. It was tried in a small world, whose robots don't carry such a "
                "sensor: give a scenario whose robots do",
                untried=True,
            )
        elif small or Exception.__str__(run.error).startswith(self.labels):
            self.report.wrong(str(run.error))
        else:
            self.report.wrong(f"{self.name}: its scenario does not run: {run.error}", untried=True)
        return None

    def check_repeatable(self, trial: Trial, first: Run, own: tuple[str, ...]) -> None:
        """Report if the same seed does not give the same run, alone or beside another world.

        own: prefixes of those names in `Run.rows` for which it is responsible.
        """

        def compared(run: Run) -> str:
            return difference(first, run, lambda what: what.startswith(own))

        again, beside = compared(trial.run(noise=2)), compared(trial.run(beside=True))
        if (again and not self.shares) or (beside and not again):
            how = "the same seed gives another run" if again else "it differs beside a second world"
            self.report.wrong(
                f"{self.name} is not repeatable: {how}, from {again or beside}. Is there a clock, "
                "a generator without a seed, or something kept in a class, a variable of the file "
                f"or of a function around it, or a default argument? Draw from {self.stream}. "
                f"{self.keep}"
            )

    # -- of parts -------------------------------------------------------------------------------

    def check_methods(self, part: Description, base: type[Description]) -> bool:
        """Report a part's own methods that can't be called as its base's; return whether none."""
        for method in own_methods(part, base):
            function = getattr(part, method)
            arguments = list(inspect.signature(getattr(base, method)).parameters)[1:]
            expected = f"expected {method}({', '.join(['self', *arguments])})"
            if not callable(function):
                self.report.wrong(f"{self.name}.{method} = {shown(function)}: {expected}")
                continue
            names = list(inspect.signature(function).parameters)
            has = f"{self.name}.{method} has the arguments ({', '.join(['self', *names])})"
            try:
                inspect.signature(function).bind(*arguments)
            except TypeError:
                self.report.wrong(f"{has}: {expected}")
            else:
                if names != arguments and sorted(names) == sorted(arguments):
                    self.report.wrong(f"{has} in another order than they are given: {expected}")
        return self.report.sound

    def check_fields(self, part: Description, base: type[Description]) -> bool:
        """Report fields that can't be copied, sent to another process or saved in a file.

        Returns whether none is wrong. Hints at attributes of the class that all worlds share.
        """
        inherited = {field.name for field in dataclasses.fields(base)}
        for field in dataclasses.fields(part):
            value = getattr(part, field.name)
            place = f"{self.name}.{field.name}"
            if inspect.isroutine(value):
                self.report.hint(
                    f"{place} = {shown(value)}: a function is not kept in a record's file, so a "
                    f"saved run is shown without {self.name}"
                )
                continue
            try:
                copy.deepcopy(value)
                pickle.dumps(value)
                kept = json.loads(json.dumps(serialize.from_description(value)))
                back = getattr(part.replace(**{field.name: serialize.to_value(kept)}), field.name)
                problem = "" if bool(back == value) else "does not come back from a record's file"
            except Exception as error:  # whatever a user's object raises
                problem = f"can't be copied or saved ({described(error)})"
            if problem:
                self.report.wrong(
                    f"{place} = {shown(value)} {problem}: a field holds numbers, text, lists and "
                    "descriptions; make the rest in on_start"
                )
            about = field.metadata.get("unit") or field.metadata.get("doc")
            if not about and field.name not in inherited and field.type in ("float", float):
                self.report.hint(
                    f"{place} says neither its unit nor its bounds: declare it as "
                    f"`{field.name}: float = number(default=..., low=..., unit=..., doc=...)`, "
                    "by mars2d.core.description"
                )
        for name, value in vars(type(part)).items():
            if isinstance(value, (list, dict, set, np.ndarray)) and not name.startswith("__"):
                self.report.hint(
                    f"{self.name}.{name}, an attribute of the class, is shared by all objects and "
                    f"worlds: what is written there is seen everywhere. {self.keep}"
                )
        return self.report.sound

    def check_finite(self, scene: Scene, where: str) -> None:
        """Report a shape with coordinates that are nan or infinite."""
        for shape in scene.shapes:
            for value in (getattr(shape, name) for name in type(shape).__slots__):
                if isinstance(value, (float, tuple, np.ndarray)) and not np.isfinite(value).all():
                    self.report.wrong(
                        f"{where} draws a {type(shape).__name__.lower()} with nan or inf in it: "
                        "leave out what is missing, and end at the range what has no end"
                    )
                    return


def own_methods(part: Description, base: type[Description]) -> list[str]:
    """Return the public methods of a part's base that its class defines anew."""
    methods = [name for name, value in vars(base).items() if inspect.isfunction(value)]
    return [
        name
        for name in methods
        if name[0] != "_" and getattr(type(part), name) is not getattr(base, name)
    ]


def _asks_for_a_sensor(error: InputError) -> bool:
    """Return whether the error is about a sensor that the robot lacks, and not a misspelt one."""
    if not isinstance(error, UnknownNameError) or not isinstance(error.obj, Sense):
        return False
    return not likely(error.name, dir(error.obj))


def with_methods(part: Part, methods: Mapping[str, Callable[..., Any]]) -> Part:
    """Return a copy of a part, of a subclass in which functions of the part replace methods."""
    kind = type(part)
    twin: Part = object.__new__(
        type(kind.__name__, (kind,), {"__module__": kind.__module__, **methods})
    )
    twin.__dict__.update(vars(part))
    return twin


def _shared_states() -> dict[str, Any]:
    return {"random": random.getstate(), "numpy.random": contents(np.random.get_state())}  # noqa: NPY002
