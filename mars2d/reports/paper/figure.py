"""Descriptions of the paper's figures: runs of experiments, and studies of their numbers."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.reports.paper.studies.base import Study

if TYPE_CHECKING:
    from mars2d.record.record import Record

__all__ = ["Figure", "Run"]


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
