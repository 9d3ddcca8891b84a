"""How much an isolated law may take, and what is said of one that has failed."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

from mars2d.core.description import real, wrong

__all__ = ["MB", "Limits", "Verdict"]

MB = 1_000_000
"""Bytes."""


@dataclass(frozen=True)
class Limits:
    """How much time, memory and output a law may take in a match; all are more than 0.

    tick: for the commands of one control step, seconds. match: for those of a whole match, as a
    chess clock counts, seconds. memory: besides what Python and numpy take at the start, MB; only
    Linux enforces it. output: what it prints and sends in a match, MB. start: for loading its file,
    seconds. Raises InputError for anything else.
    """

    tick: float = 1.0
    match: float = 60.0
    memory: float = 512
    output: float = 1
    start: float = 20.0

    def __post_init__(self) -> None:
        for field in fields(self):
            name, value = f"Limits.{field.name}", getattr(self, field.name)
            if not 0 < real(name, value, "a number > 0") < 1e9:
                raise wrong(name, value, "a number > 0, and below 1e9")


class Verdict(NamedTuple):
    """What is said of a law that has failed.

    kind: "slow", "clock", "memory", "error", "command", "exit", "output" or "start". text: one line
    with file and, where it is known, line. time: when in the match, simulated seconds.
    """

    kind: str
    text: str
    time: float
