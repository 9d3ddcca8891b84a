"""The figures of the paper, as figures.toml describes them, and what is made of them."""

from __future__ import annotations

import shlex
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from mars2d.scenario.prediction import Prediction, summary


@dataclass(frozen=True)
class Run:
    """A run of an experiment, with the title and the caption of its picture.

    times: seconds, with one panel each, later ones than the run's end show the end; without any the
    picture shows the whole run. settings: as of ``mars2d run --set``. stem: the name of the
    picture's files, without suffix.
    """

    stem: str
    experiment: str
    title: str
    shows: str
    times: Sequence[float] = ()
    settings: Sequence[str] = ()

    def times_until(self, end: float) -> list[float]:
        """Return the times of the panels of a run that ended at `end`."""
        return sorted({min(moment, end) for moment in self.times})

    def command(self, seed: int, end: float) -> str:
        """Return the command that makes only this picture."""
        words = ["mars2d", "run", self.experiment, "--headless"]
        words += [word for setting in self.settings for word in ("--set", setting)]
        words += ["--seed", str(seed)] if seed else []
        words += ["--theory", "--figure", f"{self.stem}.pdf"]
        if self.times:
            words += ["--at", ",".join(f"{moment:.10g}" for moment in self.times_until(end))]
        return shlex.join(words)


@dataclass(frozen=True)
class Figure:
    """A figure of the paper, beside what the paper reports, in our own words, and theory.

    choices: parameters that the paper leaves open.
    """

    number: int
    title: str
    section: str
    paper: str
    theory: str
    law: Sequence[str]
    source: str
    runs: Sequence[Run]
    choices: str = ""


@dataclass(frozen=True)
class Picture:
    """One picture and its numbers.

    stem: the name of its files. alt: the text for people who can't see it. size: of the .png,
    pixels. command, outcome, digest: of its run.
    """

    stem: str
    title: str
    alt: str
    caption: str
    size: tuple[int, int]
    predictions: Sequence[Prediction]
    command: str
    outcome: str
    digest: str

    def as_dict(self) -> dict[str, Any]:
        """Return command and numbers as data for JSON."""
        said = {name: getattr(self, name) for name in ("command", "outcome", "digest")}
        checks = [p.as_dict() | {"unit": p.unit} for p in self.predictions]
        return {"picture": self.stem, **said, "checks": checks}


@dataclass(frozen=True)
class Result:
    """The pictures made of a figure, and messages of errors; setting: what the robots know."""

    figure: Figure
    setting: str = ""
    pictures: Sequence[Picture] = ()
    problems: Sequence[str] = ()

    @property
    def predictions(self) -> list[Prediction]:
        """The predictions of all pictures."""
        return [p for picture in self.pictures for p in picture.predictions]

    @property
    def failed(self) -> int:
        """The number of predictions that do not hold."""
        return sum(p.ok is False for p in self.predictions)

    @property
    def ok(self) -> bool:
        """Whether all pictures were made and all predictions hold."""
        return not self.problems and not self.failed

    @property
    def verdict(self) -> str:
        """The outcome in a few words, such as ``3 of 3 predictions ok``."""
        held = summary(self.predictions) if self.predictions else "shown"
        if self.problems:
            return f"not all was made; {held}" if self.pictures else "not made"
        return held


_TOML = (files(__package__) / "figures.toml").read_text(encoding="utf-8")

FIGURES = [
    Figure(
        runs=[Run(**run) for run in described.pop("runs")],
        **described,
    )
    for described in tomllib.loads(_TOML)["figure"]
]
"""Figures 2 to 9."""
