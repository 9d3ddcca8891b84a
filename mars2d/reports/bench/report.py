"""What the suite has measured: as data, in a file, and against an earlier run."""

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

from mars2d.core.atomic import replacing
from mars2d.core.errors import InputError
from mars2d.physics.kernel import reason_without
from mars2d.physics.settings import versions

__all__ = ["ALIKE", "FORMAT", "Change", "Figures", "Report", "Row", "load_report"]

FORMAT = 1
"""The version of the file format; files of another one are refused."""

KIND = "mars2d bench"
"""What a saved report says it is."""

ALIKE = 0.05
"""By what part runs of the same program differ on a machine that does nothing else."""

USED = "used"
"""What stands for the kernel among the versions, where no reason stands why it was not used."""


@dataclass(frozen=True)
class Figures:
    """What else is known of a scene.

    sampling_time: seconds. max_overlap: what was allowed, and deepest, what was seen between
    control steps, metres. bytes: what the record takes for each robot and control step.
    """

    sampling_time: float
    max_overlap: float
    deepest: float
    bytes: float


@dataclass(frozen=True)
class Row:
    """One thing that was timed, in turns with the yardstick.

    name: as "S2 default" or "import mars2d". title: what it is. rounds: of each, how long a control
    step of the bare loop took, and how long a control step or start of this, seconds. figures: of
    a scene.
    """

    name: str
    title: str
    rounds: tuple[tuple[float, float], ...]
    figures: Figures | None = None

    @property
    def seconds(self) -> float:
        """How long one takes: the mean, as rounds of a scene differ by how much touches."""
        return fmean(mine for _, mine in self.rounds)

    @property
    def yardsticks(self) -> list[float]:
        """How long a control step of the bare loop took in each round, seconds."""
        return [bare for bare, _ in self.rounds]

    @property
    def unrest(self) -> float:
        """By what part the bare loop varied meanwhile, without the extreme fifth of the rounds."""
        quick, slow = np.percentile(self.yardsticks, [10, 90]).tolist()
        return float(slow / quick - 1)

    @property
    def shares(self) -> list[float]:
        """How many control steps of the bare loop one of these took, in each round."""
        return [mine / bare for bare, mine in self.rounds]


class Change(NamedTuple):
    """How a row compares with that of an earlier run, both in units of their yardsticks.

    times_as_fast: above 1 it is quicker now. noise: whether the difference may be chance.
    """

    times_as_fast: float
    noise: bool

    @classmethod
    def between(cls, old: Row, new: Row) -> Change:
        """Compare two rows round by round: the same ones do the same control steps.

        The difference may be chance where it is no more than `ALIKE`, or than the yardstick itself
        varied in either run, or a third as much as between them (what is quicker for one loop is
        not as much so for another), or where the middle half of the rounds holds 1.
        """
        ratios = [a / b for a, b in zip(old.shares, new.shares, strict=False)]
        low, ratio, high = np.percentile(ratios, [25, 50, 75]).tolist()
        between = abs(log(median(old.yardsticks) / median(new.yardsticks))) / 3
        chance = 1 + max(ALIKE, old.unrest, new.unrest, between)
        return cls(ratio, noise=low <= 1 <= high or max(ratio, 1 / ratio) <= chance)


def _machine() -> dict[str, str]:
    return versions() | {"cores": str(os.cpu_count()), "kernel": reason_without() or USED}


@dataclass(frozen=True)
class Report:
    """The rows of one run of the suite. date: in UTC. versions: of what the figures depend on."""

    rows: tuple[Row, ...]
    date: str = field(default_factory=lambda: f"{datetime.now(UTC):%Y-%m-%d %H:%M}")
    versions: Mapping[str, str] = field(default_factory=_machine)

    @property
    def yardstick(self) -> float:
        """How many control steps a second the bare loop made."""
        return 1 / median(bare for row in self.rows for bare in row.yardsticks)

    @property
    def without_kernel(self) -> str:
        """Why it was measured without the kernel in C, or nothing if it was used."""
        return self.versions.get("kernel", "").removeprefix(USED)

    def change(self, new: Row) -> Change | None:
        """Compare with a row of a later run; None if this run has no such row."""
        old = next((row for row in self.rows if row.name == new.name), None)
        return None if old is None else Change.between(old, new)

    def as_data(self) -> dict[str, Any]:
        """Return it as plain data, which JSON can hold."""
        head = {"kind": KIND, "format": FORMAT, "date": self.date, "versions": dict(self.versions)}
        return head | {"rows": [asdict(row) | {"seconds": row.seconds} for row in self.rows]}

    def save(self, path: Path) -> None:
        """Write it to a JSON file; InputError if it can't be."""
        with replacing(path) as file:
            file.write((json.dumps(self.as_data(), indent=1) + "\n").encode())


def load_report(path: Path) -> Report:
    """Read what `Report.save` wrote. Raises InputError for anything else."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        newer = data["kind"] == KIND and data["format"] > FORMAT
        made = data["versions"].get("mars2d", "?")
        report = None if newer else _assemble(data)
    except OSError as error:
        raise InputError(f"{path}: can't be read: {error.strerror or error}") from error
    except Exception as error:  # JSON that is something else fails in many ways
        raise InputError(f"{path}: not saved by mars2d bench, or damaged") from error
    if report is None:
        raise InputError(f"{path}: written by a newer version of MARS2D, {made}")
    return report


def _assemble(data: Any) -> Report:
    """Put a report together from plain data; raises what it may if that is not one."""
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
