"""The drives of all robots of a world, those that are equal taken together."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.base import Drive
from mars2d.description import wrong
from mars2d.errors import LawError, shown
from mars2d.usercode import called

__all__ = ["Drives"]

Float = NDArray[np.float64]
Stream = Callable[[str], np.random.Generator]

FASTEST = 1e6
"""What a drive may ask for at most, m/s and rad/s."""

LONGEST = 1e6
"""The longest dead time, in sampling times: all commands under way are kept."""

BLOCK = 256
"""For so many control steps random numbers are drawn at once."""


class Drives:
    """The drives of a world's robots: from all commands (2, n) to all twists (3, n)."""

    def __init__(self, drives: Mapping[str, Drive], sampling_time: float, stream: Stream) -> None:
        """Take the drives by their robots' names, the sampling time [s], and what opens streams.

        Raises InputError for a dead time of more than a million sampling times.
        """
        for drive in drives.values():
            if drive.dead_time > LONGEST * sampling_time:
                raise wrong(
                    f"{type(drive).__name__}.dead_time", drive.dead_time,
                    f"at most a million sampling times of {sampling_time:g} s",
                )  # fmt: skip
        names = [*drives]
        self.dead_time = np.array([drive.dead_time for drive in drives.values()])
        self._sampling_time = sampling_time
        teams = _teams([*drives.values()])
        self._teams = [
            (drive, slice(None) if len(columns) == len(drives) else np.array(columns))
            for drive, columns in teams
        ]
        self._rated = [team for team in self._teams if team[0].rates != (None, None)]
        self._noises = [
            _noise([stream(f"drive {names[i]}") for i in columns]) if drive.noise > 0 else None
            for drive, columns in teams
        ]
        self._noisy = any(noise is not None for noise in self._noises)
        self._normal: list[Float | None] = [None] * len(teams)

    def limit(self, command: Float, last: Float) -> Float:
        """Limit commands (2, n), in place, to what the drives can do after the last ones (2, n).

        Raises LawError where a drive of the user's fails.
        """
        self._saturate(command, self._teams)
        if self._rated:
            for drive, columns in self._rated:
                with called(f"drive {type(drive).__name__}", drive.accelerate):
                    command[:, columns] = drive.accelerate(
                        command[:, columns], last[:, columns], self._sampling_time
                    )
            # Rounding may have brought one beyond a limit again.
            self._saturate(command, self._rated)
        if not np.isfinite(command).all():
            raise LawError(f"a drive saturates a command to {shown(command.tolist())}")
        return command

    def _saturate(self, command: Float, teams: list[tuple[Drive, Any]]) -> None:
        for drive, columns in teams:
            with called(f"drive {type(drive).__name__}", drive.saturate):
                command[:, columns] = drive.saturate(command[:, columns])

    def draw(self) -> None:
        """Draw the noise of the control step that begins."""
        if self._noisy:
            self._normal = [None if noise is None else next(noise) for noise in self._noises]

    def twist(self, command: Float) -> Float:
        """Return the twists (3, n) that the drives make of commands (2, n), noise included.

        Raises LawError where a drive of the user's fails.
        """
        twist = np.empty((3, command.shape[1]))
        for (drive, columns), normal in zip(self._teams, self._normal, strict=True):
            with called(f"drive {type(drive).__name__}", drive.twist):
                done = command[:, columns]
                if normal is not None:
                    done = drive.disturb(done, normal)
                twist[:, columns] = drive.twist(done)
        if not (np.abs(twist) <= FASTEST).all():  # neither for NaN
            raise LawError(f"a drive asks for {shown(twist.tolist())}, more than {FASTEST:g}")
        return twist


def _teams(drives: Sequence[Drive]) -> list[tuple[Drive, list[int]]]:
    """Group robots by equal drives: pairs of a drive and the columns of its robots."""
    groups: list[tuple[Drive, list[int]]] = []
    for i, mine in enumerate(drives):
        for drive, columns in groups:
            if drive == mine and type(drive) is type(mine):
                columns.append(i)
                break
        else:
            groups.append((mine, [i]))
    return groups


def _noise(streams: list[np.random.Generator]) -> Iterator[Float]:
    """Yield standard normal numbers (2, n), each robot's from a stream of its own."""
    while True:
        blocks = [stream.standard_normal((BLOCK, 2)) for stream in streams]
        yield from np.stack(blocks, axis=-1)
