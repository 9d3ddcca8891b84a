"""The limits of an isolated law, and the verdict on one that has failed."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

from mars2d.core.description import real, wrong

MB = 1_000_000
"""Bytes."""


@dataclass(frozen=True)
class Limits:
    """How much time, memory and output a law may use in a match; all limits are > 0.

    tick: time for the commands of one control step, seconds. match: time for all commands of a
    match, counted like a chess clock, seconds. memory: in use, not reserved, in addition to Python
    and numpy at the start, MB; enforced on Linux only. output: printed and sent in a match, MB.
    start: time for loading its file, seconds. Raises InputError for anything else.
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
    """The reason why a law has failed.

    kind: "slow", "clock", "memory", "error", "command", "exit", "output" or "start". text: one line
    with the file and, if known, the line number. time: in the match, simulated seconds.
    """

    kind: str
    text: str
    time: float
