"""The findings of a check about a part, collected as sentences."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Literal

from mars2d.core.errors import InputError, LawError, UnknownNameError, counted, likely
from mars2d.core.usercode import called
from mars2d.sensors.sensing import Sense
from mars2d.testing.trial import drawn_at_random


@dataclass(frozen=True)
class Finding:
    """A sentence about a part: something "wrong", or a "hint" at a possible improvement.

    untried: whether the fault lies elsewhere, so that the part could not be tried.
    """

    kind: Literal["wrong", "hint"]
    text: str
    untried: bool = False


_NUMBER = re.compile(r"[-+]?(\d[\d.]*(e[-+]?\d+)?|\binf\b|\bnan\b)")


class CheckError(InputError):
    """A user's part is not sound; the message lists everything that is wrong.

    findings: all findings, including hints.
    """

    def __init__(self, name: str, findings: Iterable[Finding]) -> None:
        self.findings = tuple(findings)
        lines = [finding.text for finding in self.findings if finding.kind == "wrong"]
        super().__init__("\n- ".join([f"{name}: {counted(len(lines), 'thing')} wrong", *lines]))


class Report:
    """Collects findings; of those that differ only in numbers, the first is kept."""

    def __init__(self) -> None:
        self._findings: dict[str, Finding] = {}

    def wrong(self, text: str, *, untried: bool = False) -> None:
        """Add something that is wrong; untried: as in `Finding`."""
        self._add(Finding("wrong", text, untried))

    def hint(self, text: str) -> None:
        """Add something that could be better."""
        self._add(Finding("hint", text))

    def _add(self, finding: Finding) -> None:
        self._findings.setdefault(_NUMBER.sub("#", finding.text), finding)

    @property
    def sound(self) -> bool:
        """Whether nothing wrong has been found so far."""
        return not any(finding.kind == "wrong" for finding in self._findings.values())

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All findings; first those that are wrong."""
        return tuple(sorted(self._findings.values(), key=lambda finding: finding.kind == "hint"))


def judge(name: str, findings: tuple[Finding, ...]) -> None:
    """Raise CheckError if anything is wrong."""
    if any(finding.kind == "wrong" for finding in findings):
        raise CheckError(name, findings)


# -- calls of the user's code ----------------------------------------------------------------------


class Notes:
    """Reports faults in the calls of one part, over all runs.

    name: the class or function. own: the random generator that it should use, in words. keep: where
    it should keep things, as a sentence. small_world: whether it is tried in the small world, since
    no scenario was given.
    """

    def __init__(self, name: str, report: Report, own: str, keep: str) -> None:
        self.name, self.report, self.own, self.keep = name, report, own, keep
        self.shared_randomness = False
        self.small_world = False

    @contextmanager
    def calling(
        self, method: str, function: Callable[..., Any], time: float | None, robot: str = ""
    ) -> Iterator[None]:
        """Report an exception in one call, and the use of Python's shared random generators.

        robot: whose law or sensor is called. After reporting an exception, it raises `Noted`.
        """
        where = f"{self.name}.{method}" if method else self.name
        try:
            shared = drawn_at_random(lambda generator: self._shared(where, generator))
            with shared, called(where, function, robot):
                yield
        except InputError as error:
            if self.small_world and _asks_for_a_sensor(error):
                self.report.wrong(
                    f"{said(error, time)}. It was tried in a small world, whose robots don't carry "
                    "such a sensor: give a scenario whose robots do",
                    untried=True,
                )
            else:
                self.report.wrong(said(error, time))
            raise Noted(str(error)) from error

    def _shared(self, where: str, generator: str) -> None:
        self.shared_randomness = True
        self.report.wrong(
            f"{where} draws from {generator}, which all of Python shares: the same seed would "
            f"not give the same run; draw from {self.own}"
        )


def _asks_for_a_sensor(error: InputError) -> bool:
    """Return whether the error is about a sensor that the robot lacks, and not a misspelt one."""
    if not isinstance(error, UnknownNameError) or not isinstance(error.obj, Sense):
        return False
    return not likely(error.name, dir(error.obj))


class Noted(LawError):  # noqa: N818 - it only stops the run
    """Raised for an error that is in the report already."""


def said(error: InputError, time: float | None) -> str:
    """Return the message of an error, with the time, and the robot if it is a law's or sensor's."""
    if not isinstance(error, LawError):
        return f"{error}{at(time)}"
    error.time = time if error.time is None else error.time
    return str(error)


def at(time: float | None) -> str:
    """Return the time of an observation as the end of a sentence, or nothing."""
    return "" if time is None else f" (at {time:g} s)"
