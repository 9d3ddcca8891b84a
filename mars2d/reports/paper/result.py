"""What was made of a figure: its pictures, with their numbers, as plain data."""

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

    stem: the name of its files without suffix; they are a .png and a .pdf. title: a few words. alt:
    what is to be seen, for those who don't see it. caption: what it shows. size: width and height
    of the .png, pixels. command: the command that makes it alone, or empty. outcome: how the run
    ended, or empty. digest: of the run's record, or empty. predictions: what formulas say of it.
    columns: the numbers that a chart is made of, columns by their names.
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
        """Return all but the looks, as JSON knows it; numbers that are not finite are None."""
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
    """What was made of a figure.

    number: the figure's. setting: what its robots know, as the experiment's file says. pictures:
    those that were made. problems: what went wrong, in words; empty when all was made.
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
        """How many predictions do not hold."""
        return sum(not p.ok for p in self.predictions)

    @property
    def ok(self) -> bool:
        """Whether all pictures were made and all predictions hold."""
        return not self.problems and not self.failed

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON knows it."""
        return {
            "figure": self.number,
            "ok": self.ok,
            "problems": list(self.problems),
            "pictures": [picture.as_dict() for picture in self.pictures],
        }
