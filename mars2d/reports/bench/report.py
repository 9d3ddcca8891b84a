"""The suite's measurements: as data, in a file, and compared with an earlier run."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from math import inf, log
from pathlib import Path
from statistics import fmean, median
from typing import Any, NamedTuple

import numpy as np

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.physics.islands import reason_without
from mars2d.physics.settings import versions

FORMAT = 1
"""The version of the file format; files of another version are refused."""

KIND = "mars2d bench"
"""The kind that a saved report states."""

ALIKE = 0.05
"""The relative difference between runs of the same program on an idle machine."""

COMPILED = "compiled"
"""The entry of the engine among the versions; otherwise the reason why it ran in Python."""


@dataclass(frozen=True)
class Figures:
    """Further figures of a scene.

    sampling_time: seconds. max_overlap: the overlap allowed, metres. deepest: the deepest overlap
    between control steps, metres. bytes: the size of the record per robot and control step.
    """

    sampling_time: float
    max_overlap: float
    deepest: float
    bytes: float


@dataclass(frozen=True)
class Row:
    """One thing that was timed, in turns with the yardstick.

    name: for example "S2 default" or "import mars2d". title: a description. rounds: for each
    round, the times of a control step of the bare loop and of a control step or start of this row,
    seconds. figures: those of a scene.
    """

    name: str
    title: str
    rounds: tuple[tuple[float, float], ...]
    figures: Figures | None = None

    @property
    def seconds(self) -> float:
        """The mean time of a step or start; rounds of a scene differ by their contacts."""
        return fmean(mine for _, mine in self.rounds)

    @property
    def yardsticks(self) -> list[float]:
        """The time of a control step of the bare loop in each round, seconds."""
        return [bare for bare, _ in self.rounds]

    @property
    def unrest(self) -> float:
        """The relative variation of the bare loop, without the extreme fifth of the rounds."""
        quick, slow = np.percentile(self.yardsticks, [10, 90]).tolist()
        return float(slow / quick - 1)

    @property
    def shares(self) -> list[float]:
        """The time of a step or start in each round, in control steps of the bare loop."""
        return [mine / bare for bare, mine in self.rounds]


class Change(NamedTuple):
    """The comparison of a row with that of an earlier run, both in units of their yardsticks.

    times_as_fast: above 1, the new run is faster. noise: whether the difference may be chance.
    """

    times_as_fast: float
    noise: bool

    @classmethod
    def between(cls, old: Row, new: Row) -> Change:
        """Compare two rows round by round: equal rounds do the same control steps.

        The difference counts as chance if it is at most `ALIKE`, or at most the variation of the
        yardstick in either run, or at most a third of the yardstick's change between the runs (a
        machine's speed-up is not the same for all loops), or if the middle half of the rounds
        contains 1.
        """
        ratios = [a / b for a, b in zip(old.shares, new.shares, strict=False)]
        low, ratio, high = np.percentile(ratios, [25, 50, 75]).tolist()
        between = abs(log(median(old.yardsticks) / median(new.yardsticks))) / 3
        chance = 1 + max(ALIKE, old.unrest, new.unrest, between)
        return cls(ratio, noise=low <= 1 <= high or max(ratio, 1 / ratio) <= chance)


def _machine() -> dict[str, str]:
    return versions() | {"cores": str(os.cpu_count()), "engine": reason_without() or COMPILED}


@dataclass(frozen=True)
class Report:
    """The rows of one run of the suite. date: in UTC. versions: of everything that matters."""

    rows: tuple[Row, ...]
    date: str = field(default_factory=lambda: f"{datetime.now(UTC):%Y-%m-%d %H:%M}")
    versions: Mapping[str, str] = field(default_factory=_machine)

    @property
    def yardstick(self) -> float:
        """The number of control steps per second of the bare loop."""
        return 1 / median(bare for row in self.rows for bare in row.yardsticks)

    @property
    def uncompiled(self) -> str:
        """The reason why the engine ran in Python, or an empty text if it was compiled.

        In reports of earlier versions the same was said of the kernel that it had then.
        """
        former = self.versions.get("kernel", "").removeprefix("used")
        return self.versions.get("engine", former).removeprefix(COMPILED)

    def change(self, new: Row) -> Change | None:
        """Compare with a row of a later run; None if this run has no such row."""
        old = next((row for row in self.rows if row.name == new.name), None)
        return None if old is None else Change.between(old, new)

    def as_data(self) -> dict[str, Any]:
        """Return the report as plain data for JSON."""
        head = {"kind": KIND, "format": FORMAT, "date": self.date, "versions": dict(self.versions)}
        return head | {"rows": [asdict(row) | {"seconds": row.seconds} for row in self.rows]}

    def save(self, path: Path) -> None:
        """Write the report to a JSON file. Raises InputError if that fails."""
        with atomic_write(path) as file:
            file.write((json.dumps(self.as_data(), indent=1) + "\n").encode())


def load_report(path: Path) -> Report:
    """Read a report that `Report.save` wrote. Raises InputError for any other file."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        newer = data["kind"] == KIND and data["format"] > FORMAT
        made = data["versions"].get("mars2d", "?")
        report = None if newer else _assemble(data)
    except OSError as error:
        raise InputError(f"{path}: can't be read: {error.strerror or error}") from error
    except Exception as error:  # other JSON fails in many ways
        raise InputError(f"{path}: not saved by mars2d bench, or damaged") from error
    if report is None:
        raise InputError(f"{path}: written by a newer version of MARS2D, {made}")
    return report


def _assemble(data: Any) -> Report:
    """Return a report made of plain data; raises any kind of error if the data are not a report."""
    if (data["kind"], data["format"]) != (KIND, FORMAT):
        raise ValueError(data["kind"])
    rows = []
    for row in data["rows"]:
        rounds = tuple((float(bare), float(mine)) for bare, mine in row["rounds"])
        if not rounds or not all(0 < time < inf for pair in rounds for time in pair):
            raise ValueError(row)
        figures = None if row["figures"] is None else Figures(**row["figures"])
        rows.append(Row(str(row["name"]), str(row["title"]), rounds, figures))
    if not rows:
        raise ValueError(data)
    return Report(tuple(rows), str(data["date"]), dict(data["versions"]))
