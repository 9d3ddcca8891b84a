"""What a figure of the paper is made of: runs of experiments, and charts of their numbers."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.scenario.prediction import Prediction

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

    from mars2d.record.record import Record

__all__ = ["Figure", "Run", "Study"]


@dataclass(frozen=True)
class Run:
    """A run of an experiment, and when its picture shows it.

    experiment: an example's name, or a file. title: of the picture, a few words. shows: what is to
    be seen in it. times: seconds, a panel each; those after the run's end show the end; without
    any, the picture shows the whole run. options: as of `mars2d.run`. name: tells runs of the same
    experiment apart.
    """

    experiment: str
    title: str
    shows: str
    times: tuple[float, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""

    def stem(self, number: int) -> str:
        """Return the name of its files as a part of a figure."""
        return "_".join(filter(None, [f"fig{number}", Path(self.experiment).stem, self.name]))

    def times_until(self, end: float) -> list[float]:
        """Return the times of the panels of a run that ended at `end`."""
        return sorted({min(moment, end) for moment in self.times})

    def command(self, stem: str, seed: int, end: float) -> str:
        """Return the command that makes the picture alone."""
        words = ["mars2d", "run", self.experiment, "--headless"]
        for name, value in self.options.items():
            words += ["--set", f"{name}={value if isinstance(value, str) else repr(value)}"]
        words += ["--seed", str(seed)] if seed else []
        words += ["--theory", "--figure", f"{stem}.pdf"]
        if self.times:
            words += ["--at", ",".join(f"{moment:.10g}" for moment in self.times_until(end))]
        return shlex.join(words)


@dataclass(frozen=True)
class Study:
    """A chart of numbers: what goes beyond one picture of one run.

    title, shows, alt: as a picture's. draw: returns a new drawing each time. predictions: what
    formulas say of the numbers. columns: the numbers.
    """

    title: str
    shows: str
    alt: str
    draw: Callable[[], Drawing]
    predictions: tuple[Prediction, ...] = ()
    columns: Mapping[str, Sequence[float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Figure:
    """A figure of the paper: what it shows, what the paper and theory say, what it is made of.

    paper: what the paper reports, in our own words. theory: what is predicted. law: formulas, as
    `typeset` reads them. source: where the law is from. choices: what the paper leaves open, or
    empty. studies: functions that get the records of the runs, by the names of their files. work:
    how long it takes, in about seconds: the longest is begun first.
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
