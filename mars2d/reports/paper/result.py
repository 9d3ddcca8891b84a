"""The result of making a figure: its pictures and their numbers, as plain data."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from mars2d.scenario.prediction import Prediction

__all__ = ["Picture", "Result"]


@dataclass(frozen=True)
class Picture:
    """One picture and its numbers.

    stem: the name of its files, a .png and a .pdf, without suffix. title: a few words. alt: the
    alternative text for people who can't see it. caption: the text below it. size: width and height
    of the .png, pixels. command: the command that makes only this picture, or empty. outcome: the
    run's end, or empty. digest: that of the run's record, or empty. predictions: those of formulas.
    columns: the numbers in a chart, by their names.
    """

    stem: str
    title: str
    alt: str
    caption: str
    size: tuple[int, int]
    command: str = ""
    outcome: str = ""
    digest: str = ""
    predictions: tuple[Prediction, ...] = ()
    columns: Mapping[str, Sequence[float]] = field(default_factory=dict)

    def as_dict(self) -> dict[str, Any]:
        """Return commands and numbers as data for JSON; numbers that are not finite are None."""
        columns = {
            name: [float(v) if math.isfinite(v) else None for v in values]
            for name, values in self.columns.items()
        }
        return {
            "picture": self.stem,
            "command": self.command,
            "outcome": self.outcome,
            "digest": self.digest,
            "checks": [p.as_dict() | {"unit": p.unit} for p in self.predictions],
            "columns": columns,
        }


@dataclass(frozen=True)
class Result:
    """The result of making a figure.

    number: the figure's. setting: the robots' knowledge, as the experiment's file states it.
    pictures: those that were made. problems: messages of errors; empty if everything was made.
    """

    number: int
    setting: str = ""
    pictures: tuple[Picture, ...] = ()
    problems: tuple[str, ...] = ()

    @property
    def predictions(self) -> tuple[Prediction, ...]:
        """The predictions of all pictures."""
        return tuple(p for picture in self.pictures for p in picture.predictions)

    @property
    def failed(self) -> int:
        """The number of predictions that do not hold."""
        return sum(not p.ok for p in self.predictions)

    @property
    def ok(self) -> bool:
        """Whether all pictures were made and all predictions hold."""
        return not self.problems and not self.failed

    def as_dict(self) -> dict[str, Any]:
        """Return the result as data for JSON."""
        return {
            "figure": self.number,
            "ok": self.ok,
            "problems": list(self.problems),
            "pictures": [picture.as_dict() for picture in self.pictures],
        }
