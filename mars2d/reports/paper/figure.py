"""A figure of the paper: its runs and studies, and the pictures and numbers made from them."""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.reports.paper.studies.base import Study
from mars2d.scenario.prediction import Prediction

if TYPE_CHECKING:
    from mars2d.world.record import Record


@dataclass(frozen=True)
class Run:
    """A run of an experiment, and the times that its picture shows.

    experiment: an example's name, or a file. title: the picture's title. shows: the picture's
    caption. times: seconds, with one panel each; times after the run's end show the end, and
    without any times the picture shows the whole run. options: as for `mars2d.run`. name: tells
    runs of the same experiment apart.
    """

    experiment: str
    title: str
    shows: str
    times: tuple[float, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""

    def stem(self, number: int) -> str:
        """Return the name of the picture's files, without suffix; number: the figure's."""
        return "_".join(filter(None, [f"fig{number}", Path(self.experiment).stem, self.name]))

    def times_until(self, end: float) -> list[float]:
        """Return the times of the panels of a run that ended at `end`."""
        return sorted({min(moment, end) for moment in self.times})

    def command(self, stem: str, seed: int, end: float) -> str:
        """Return the command that makes only this picture."""
        words = ["mars2d", "run", self.experiment, "--headless"]
        for name, value in self.options.items():
            words += ["--set", f"{name}={value if isinstance(value, str) else repr(value)}"]
        words += ["--seed", str(seed)] if seed else []
        words += ["--theory", "--figure", f"{stem}.pdf"]
        if self.times:
            words += ["--at", ",".join(f"{moment:.10g}" for moment in self.times_until(end))]
        return shlex.join(words)


@dataclass(frozen=True)
class Figure:
    """A figure of the paper, with the statements of the paper and of theory, its runs and studies.

    paper: the paper's report, in our own words. theory: the predictions. law: formulas for
    `typeset`. source: the source of the law. choices: parameters that the paper leaves open, or
    empty. studies: functions of the records of all runs, by the names of their files. work: the
    approximate time that the figure takes, seconds; the longest figures are begun first.
    """

    number: int
    title: str
    section: str
    paper: str
    theory: str
    law: tuple[str, ...]
    source: str
    runs: tuple[Run, ...]
    studies: Mapping[str, Callable[[Sequence[Record]], Study]] = field(default_factory=dict)
    choices: str = ""
    work: float = 1.0

    @property
    def stems(self) -> list[str]:
        """The names of all its files, without suffix."""
        runs = [run.stem(self.number) for run in self.runs]
        return runs + [f"fig{self.number}_{name}" for name in self.studies]

    @property
    def files(self) -> list[str]:
        """The names of all its files."""
        return [f"{stem}{suffix}" for stem in self.stems for suffix in (".png", ".pdf")]


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
