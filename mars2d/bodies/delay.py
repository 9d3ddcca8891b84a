"""A delay line between commands and their effect."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import ROUNDING

Float = NDArray[np.float64]
Index = NDArray[np.intp]


class DelayLine:
    """Commands on their way: a command issued at time t takes effect at t + delay.

    The delay need not be a multiple of the sampling time, nor the same for all n columns; then the
    commands in effect change within each sampling time. Before the first command arrives, commands
    are zero.
    """

    def __init__(self, delay: float | Float, sampling_time: float, still: Float) -> None:
        """Take the delay [s], one for all or (n,), the sampling time [s], and commands of 0."""
        delays = np.broadcast_to(np.asarray(delay, dtype=float), still.shape[1:])
        whole = np.floor(delays / sampling_time + ROUNDING).astype(int)
        rest = _rounded(delays - whole * sampling_time, ROUNDING * sampling_time)
        starts = np.unique([0.0, *rest]).tolist()
        ends = [*starts[1:], sampling_time]
        self._segments = [
            (end - start, _groups(whole + (rest > start)))
            for start, end in zip(starts, ends, strict=True)
        ]
        oldest = max(age for _, groups in self._segments for age, _ in groups)
        self._sent = [still] * (oldest + 1)  # a ring: the next command replaces the oldest
        self._next = 0

    def send(self, command: Float) -> list[tuple[float, Float]]:
        """Issue a command (m, n), and return those in effect meanwhile: (seconds, command)."""
        now = self._next
        self._sent[now] = command
        self._next = (now + 1) % len(self._sent)
        return [(duration, self._in_effect(groups, now)) for duration, groups in self._segments]

    def _in_effect(self, groups: list[tuple[int, Index]], now: int) -> Float:
        """Return the commands (m, n) in effect, given the age of each group of columns."""
        sent, (age, _) = self._sent, groups[0]
        if len(groups) == 1:
            return sent[now - age]
        command = sent[now - age].copy()
        for age, columns in groups[1:]:
            command[:, columns] = sent[now - age][:, columns]
        return command


def _rounded(rest: Float, rounding: float) -> Float:
    """Return times >= 0, each group that differs by less than `rounding` set to its first."""
    result = np.empty_like(rest)
    kept = 0.0
    for i in np.argsort(rest, kind="stable").tolist():
        if rest[i] >= kept + rounding:
            kept = float(rest[i])
        result[i] = kept
    return result


def _groups(age: NDArray[np.int_]) -> list[tuple[int, Index]]:
    """Return the ages that occur, in control steps, each with its columns."""
    return [(int(a), np.flatnonzero(age == a)) for a in np.unique(age)]
