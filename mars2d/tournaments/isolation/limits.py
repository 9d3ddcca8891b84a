"""The limits of an isolated law, and the verdict on one that has failed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from mars2d.core.description import real, wrong

MB = 1_000_000
"""Bytes."""

OUT_OF_TIME = ("slow", "clock")
"""The kinds of verdicts on a law that took too long, for which the match had to wait."""


@dataclass(frozen=True)
class Limits:
    """What a law may use in a match; all numbers are > 0.

    tick: time for the commands of one control step, seconds. match: time for all commands of a
    match, counted like a chess clock, seconds. memory: in addition to Python and numpy, MB;
    enforced on Linux only. output: printed in a match, and sent in a control step, MB. start: time
    for loading its file, seconds. reads: files and folders that it may read, besides those beside
    its own file. Raises InputError for anything else.
    """

    tick: float = 1.0
    match: float = 10.0
    memory: float = 512
    output: float = 1
    start: float = 10.0
    reads: Sequence[str | Path] = ()

    def __post_init__(self) -> None:
        for field in ("tick", "match", "memory", "output", "start"):
            name, value = f"Limits.{field}", getattr(self, field)
            if not 0 < real(name, value, "a number > 0") < 1e9:
                raise wrong(name, value, "a number > 0, and below 1e9")
        reads = self.reads
        if isinstance(reads, (str, Path)) or not all(Path(each).exists() for each in reads):
            raise wrong("Limits.reads", reads, "a list of files and folders that are there")
        object.__setattr__(self, "reads", tuple(str(Path(each).absolute()) for each in reads))


LIMITS = Limits()
"""The default limits."""


class Verdict(NamedTuple):
    """The reason why a law has failed.

    kind: "slow", "clock", "memory", "error", "command", "exit", "output" or "start"; "late" for a
    match that was not played. text: one line with the file and, if known, the line number. time: in
    the match, simulated seconds.
    """

    kind: str
    text: str
    time: float
