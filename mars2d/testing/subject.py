"""What is on trial, and the checks for all kinds of parts: arguments and repeatability."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

from mars2d.addons.base import Addon
from mars2d.core.deadline import Deadline
from mars2d.core.description import Description
from mars2d.core.errors import InputError, UnknownNameError, counted, likely
from mars2d.core.usercode import name_of
from mars2d.sensors.sensing import Sense
from mars2d.testing.trial import Placed, difference, run

_NUMBER = re.compile(r"[-+]?(\d[\d.]*(e[-+]?\d+)?|\binf\b|\bnan\b)")

KEEP = "Keep things in attributes of self, set in on_start"


@dataclass(frozen=True)
class Finding:
    """Something wrong with a part, as a sentence.

    untried: whether the fault lies elsewhere, so that the part could not be tried.
    """

    text: str
    untried: bool = False


class CheckError(InputError):
    """A user's part is not sound; the message, and `findings`, list everything that is wrong."""

    def __init__(self, name: str, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        lines = [finding.text for finding in self.findings]
        super().__init__("\n- ".join([f"{name}: {counted(len(lines), 'thing')} wrong", *lines]))


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
        self._findings.setdefault(_NUMBER.sub("#", text), Finding(text, untried))

    def conclude(self) -> None:
        """Raise CheckError if anything is wrong."""
        if self._findings:
            raise CheckError(self._title, self._findings.values())

    def check_runs(
        self,
        place: Callable[[], Placed],
        deadline: Deadline | None,
        *,
        small: bool,
        looker: Addon | None = None,
        own: tuple[str, ...] = ("",),
    ) -> None:
        """Report a run that breaks down, or that the same seed does not repeat.

        place: returns a scenario with the part or law in it, and the law of its team. small:
        whether that is the small world, in which nothing else can fail. looker: an add-on that
        looks on in the first run. own: how the names in `Run.rows` begin for which the subject is
        responsible.
        """
        with deadline or Deadline() as limit:
            again = partial(run, self.name, place, limit)
            plain = again(looker)
            if looker and plain.error is None:
                plain = again()
            if plain.error is not None:
                self._blame(plain.error, small)
                return
            noisy = difference(plain, again(noise=2))
            found = noisy or difference(plain, again(beside=True))
            if found is None or not (small or found[1].startswith(own)):
                return
            another = f"the same seed gives another run, from step {found[0]} on ({found[1]})"
            if noisy and difference(plain, again()) is None:
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

    def check_part(self, part: Description, base: type[Description]) -> bool:
        """Check the methods of a part of a base class; return whether all is well."""
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
        return not self._findings


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
