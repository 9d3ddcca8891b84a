"""Parts and laws that note what is done by them while they are tried."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from mars2d.core.description import Description
from mars2d.core.errors import InputError, LawError, UnknownNameError, likely
from mars2d.core.usercode import called
from mars2d.sensors.sensing import Sense
from mars2d.testing.finding import Report
from mars2d.testing.trial import drawn_at_random

__all__ = ["Noted", "Notes", "at", "with_methods"]

Part = TypeVar("Part", bound=Description)


class Notes:
    """What was seen of one part over all runs.

    name: the class or function. own: the random generator that is to be used, in words. keep:
    where things are to be kept, as a sentence. small_world: whether it is tried in that, since
    nobody gave a scenario.
    """

    def __init__(self, name: str, report: Report, own: str, keep: str) -> None:
        self.name, self.report, self.own, self.keep = name, report, own, keep
        self.shared_randomness = False
        self.small_world = False

    @contextmanager
    def calling(
        self, method: str, function: Callable[..., Any], time: float | None
    ) -> Iterator[None]:
        """Note what one call raises, and whether it uses randomness that all of Python shares."""
        where = f"{self.name}.{method}" if method else self.name
        try:
            shared = drawn_at_random(lambda generator: self._shared(where, generator))
            with shared, called(where, function):
                yield
        except InputError as error:
            if self.small_world and _asks_for_a_sensor(error):
                self.report.wrong(
                    f"{error}{at(time)}. It was tried in a small world, whose robots don't carry "
                    "such a sensor: give a scenario whose robots do",
                    untried=True,
                )
            else:
                self.report.wrong(f"{error}{at(time)}")
            raise Noted(str(error)) from error

    def _shared(self, where: str, generator: str) -> None:
        self.shared_randomness = True
        self.report.wrong(
            f"{where} draws from {generator}, which all of Python shares: the same seed would "
            f"not give the same run; draw from {self.own}"
        )


def _asks_for_a_sensor(error: InputError) -> bool:
    """Return whether it is raised for a sensor that a robot lacks, and that is not misspelt."""
    if not isinstance(error, UnknownNameError) or not isinstance(error.obj, Sense):
        return False
    return not likely(error.name, dir(error.obj))


class Noted(LawError):  # noqa: N818 - it is no error of its own
    """An error that is in the report already."""


def at(time: float | None) -> str:
    """Return when something was seen."""
    return "" if time is None else f" (at {time:g} s)"


def with_methods(part: Part, methods: dict[str, Any]) -> Part:
    """Return a part like `part`, of a class derived from its own with methods replaced."""
    kind = type(part)
    body = {"__module__": kind.__module__, "__doc__": kind.__doc__, **methods}
    twin: Part = object.__new__(type(kind.__name__, (kind,), body))
    twin.__dict__.update(vars(part))
    return twin
