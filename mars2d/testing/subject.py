"""What is on trial, and the checks for all kinds of parts: arguments, fields, repeatability."""

from __future__ import annotations

import dataclasses
import inspect
import json
import pickle
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np

from mars2d.addons.base import Addon
from mars2d.core.deadline import Deadline
from mars2d.core.description import Description
from mars2d.core.errors import InputError, UnknownNameError, likely, shown
from mars2d.core.hints import described
from mars2d.core.scene import Scene
from mars2d.core.usercode import called, name_of
from mars2d.scenario import serialize
from mars2d.sensors.sensing import Sense
from mars2d.testing.finding import CheckError, Finding
from mars2d.testing.trial import Placed, changed, difference, run, state
from mars2d.world.world import World

_NUMBER = re.compile(r"[-+]?(\d[\d.]*(e[-+]?\d+)?|\binf\b|\bnan\b)")

KEEP = "Keep things in attributes of self, set in on_start"


class Subject:
    """A part or law on trial, and what has been found.

    name: of its class, or of the law.
    """

    def __init__(self, family: str, what: Any, stream: str, keep: str) -> None:
        """Take a part or law, and its family.

        stream: the random generator that it should use, in words. keep: where it should keep
        things, as a sentence.
        """
        self.name = type(what).__name__ if isinstance(what, Description) else name_of(what)
        self._title = f"{family} {self.name}"
        self._findings: dict[str, Finding] = {}
        self._stream, self._keep = stream, keep
        key = f"{family} {what.key!r} " if hasattr(what, "key") else f"{self.name} "
        self._labels = key, f"{self.name}."  # of the errors for which it is responsible

    def wrong(self, text: str, *, untried: bool = False) -> None:
        """Add something wrong; of sentences that differ only in numbers, the first counts."""
        self._findings.setdefault(_NUMBER.sub("#", text), Finding("wrong", text, untried))

    def hint(self, text: str) -> None:
        """Add something that could be better."""
        self._findings.setdefault(_NUMBER.sub("#", text), Finding("hint", text))

    @property
    def sound(self) -> bool:
        """Whether nothing wrong has been found so far."""
        return not any(finding.kind == "wrong" for finding in self._findings.values())

    def hints(self) -> tuple[Finding, ...]:
        """Return the hints; raise CheckError if anything is wrong."""
        found = sorted(self._findings.values(), key=lambda finding: finding.kind == "hint")
        if not self.sound:
            raise CheckError(self._title, found)
        return tuple(found)

    def check_runs(
        self,
        place: Callable[[], Placed],
        deadline: Deadline | None,
        *,
        small: bool,
        looker: Addon | None = None,
        own: tuple[str, ...] = ("",),
        besides: str = "",
    ) -> None:
        """Report a run that breaks down, or that the same seed does not repeat.

        place: returns a scenario with the part or law in it, and the law of its team. small:
        whether that is the small world, in which nothing else can fail. looker: an add-on that
        looks on in the first run. own: how the names in `Run.rows` begin for which the subject is
        responsible. besides: the key of an add-on that may keep what it finds when it is looked at.
        """
        with deadline or Deadline() as limit:
            again = partial(run, self.name, place, limit)
            looked = plain = again(looker)
            if looker and looked.error is None:
                plain = again()
            if plain.error is not None:
                self._blame(plain.error, small)
                return
            noisy = difference(plain, again(noise=2))
            beside = noisy or difference(plain, again(beside=True))
            found = beside or (difference(plain, looked, besides) if self.sound else None)
            if found is None or not (small or found[1].startswith(own)):
                return
            another = f"the same seed gives another run, from step {found[0]} on ({found[1]})"
            if beside is None:
                self.wrong(
                    f"{self.name} is not repeatable: {another}, where it is read or drawn once "
                    "more: how often that is depends on rates, laws and windows, so it must not "
                    "matter; do this in on_step"
                )
            elif noisy and difference(plain, again()) is None:
                self.wrong(
                    f"{self.name} draws from random or numpy.random, which all of Python shares: "
                    f"{another}; draw from {self._stream}"
                )
            else:
                self.wrong(
                    f"{self.name} is not repeatable: {another}, alone or beside a second world. Is "
                    "there a clock, a generator without a seed, or something kept in a class, a "
                    "variable of the file or of a function around it, or a default argument? Draw "
                    f"from {self._stream}. {self._keep}"
                )

    def _blame(self, error: InputError, small: bool) -> None:
        """Report the error that ended a run, and whether it is another's."""
        if small and _asks_for_a_sensor(error):
            self.wrong(
                f"{error}. It was tried in a small world, whose robots don't carry such a "
                "sensor: give a scenario whose robots do",
                untried=True,
            )
        elif small or Exception.__str__(error).startswith(self._labels):
            self.wrong(str(error))
        else:
            self.wrong(f"{self.name}: its scenario does not run: {error}", untried=True)

    @contextmanager
    def looking(self, part: Any, method: str, world: World, besides: str = "") -> Iterator[None]:
        """Report what the calls of a part's method change that must only look.

        besides: the key of an add-on that may change itself.
        """
        before = state(world)
        with called(f"{self.name}.{method}", getattr(part, method)):
            yield
        what = changed(before, state(world), besides)
        if what:
            self.wrong(
                f"{self.name}.{method} changes {what} (at {world.time:g} s): it is called "
                "at any time, or never, so it must only look; do this in on_step"
            )

    def check_part(self, part: Description, base: type[Description]) -> bool:
        """Check the methods and fields of a part of a base class; return whether all is well."""
        for method in own_methods(part, base):
            function = getattr(part, method)
            arguments = list(inspect.signature(getattr(base, method)).parameters)[1:]
            names = list(inspect.signature(function).parameters)
            fits = names == arguments or sorted(names) != sorted(arguments)
            try:
                inspect.signature(function).bind(*arguments)
            except TypeError:
                fits = False
            if not fits:
                self.wrong(
                    f"{self.name}.{method} has the arguments ({', '.join(['self', *names])}): "
                    f"expected {method}({', '.join(['self', *arguments])}), in this order"
                )
        if self.sound:
            self._check_fields(part)
        return self.sound

    def _check_fields(self, part: Description) -> None:
        """Report fields that can't be sent to another process or saved in a file.

        Hints at attributes of the class that all worlds share.
        """
        for field in dataclasses.fields(part):
            value = getattr(part, field.name)
            place = f"{self.name}.{field.name} = {shown(value)}"
            if inspect.isroutine(value):
                self.hint(
                    f"{place}: a function is not kept in a record's file, so a saved run is shown "
                    f"without {self.name}"
                )
                continue
            try:
                pickle.dumps(value)
                kept = json.loads(json.dumps(serialize.from_description(value)))
                back = getattr(part.replace(**{field.name: serialize.to_value(kept)}), field.name)
                problem = "" if bool(back == value) else "does not come back from a record's file"
            except Exception as error:  # whatever a user's object raises
                problem = f"can't be copied or saved ({described(error)})"
            if problem:
                self.wrong(
                    f"{place} {problem}: a field holds numbers, text, lists and descriptions; make "
                    "the rest in on_start"
                )
        for name, value in vars(type(part)).items():
            if isinstance(value, (list, dict, set, np.ndarray)) and not name.startswith("__"):
                self.hint(
                    f"{self.name}.{name}, an attribute of the class, is shared by all objects and "
                    f"worlds: what is written there is seen everywhere. {self._keep}"
                )

    def check_finite(self, scene: Scene, method: str) -> None:
        """Report a shape with coordinates that are nan or infinite."""
        for shape in scene.shapes:
            for value in (getattr(shape, name) for name in type(shape).__slots__):
                if isinstance(value, (float, tuple, np.ndarray)) and not np.isfinite(value).all():
                    self.wrong(
                        f"{self.name}.{method} draws a {type(shape).__name__.lower()} with nan or "
                        "inf in it: leave out what is missing, and end at the range what has no end"
                    )
                    return


def own_methods(part: Description, base: type[Description]) -> list[str]:
    """Return the public methods of a part's base that its class defines anew."""
    return [
        name
        for name, value in vars(base).items()
        if inspect.isfunction(value) and name[0] != "_" and getattr(type(part), name) is not value
    ]


def _asks_for_a_sensor(error: InputError) -> bool:
    """Return whether the error is about a sensor that the robot lacks, and not a misspelt one."""
    if not isinstance(error, UnknownNameError) or not isinstance(error.obj, Sense):
        return False
    return not likely(error.name, dir(error.obj))
