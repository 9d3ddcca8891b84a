"""The drives of all robots of a world; robots with equal drives are handled together."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.drives.base import Drive
from mars2d.core.arrays import within
from mars2d.core.description import wrong
from mars2d.core.errors import LawError, shown
from mars2d.core.usercode import called

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Stream = Callable[[str], np.random.Generator]

MAX_TWIST = 1e6
"""The largest velocity that a drive may ask for, m/s and rad/s."""

LARGEST = sys.float_info.max
"""The largest finite number."""

MAX_DEAD_TIME = 1e6
"""The longest dead time, in sampling times: all commands under way are kept."""

PARTS = 8
"""The parts of a control step in which commands change that follow a ramp as stairs."""

ROWS = "expected three, as `return v, 0, omega`: velocities ahead and to the left, and the spin"

BLOCK = 256
"""The number of control steps for which random numbers are drawn at once."""


class _Team:
    """Robots with equal drives."""

    def __init__(self, drive: Drive, columns: Index | None, noise: _White | None) -> None:
        """Take the drive, the robots' columns, None for all, and their random numbers."""
        self.drive, self.noise = drive, noise
        self.columns = slice(None) if columns is None else columns
        self.inputs = len(drive.inputs)
        self.normal: Float | None = None  # those of this control step
        name = f"drive {type(drive).__name__}"
        self.saturating = called(name, drive.saturate)
        self.accelerating = called(name, drive.accelerate)
        self.ramping = called(name, drive.ramp)
        self.moving = called(name, drive.twist)

    def part(self, command: Float) -> Float:
        """Return the team's columns of all robots' commands, and the rows of its inputs.

        For everybody, and all rows, it is the array itself.
        """
        if len(command) != self.inputs:
            command = command[: self.inputs]
        return command if isinstance(self.columns, slice) else command[:, self.columns]

    def write(self, command: Float, mine: Float) -> None:
        """Write the team's part of all robots' commands."""
        command[: self.inputs, self.columns] = mine


class Drives:
    """The drives of a world's robots: from all commands (m, n) to all twists (3, n).

    m: the largest number of inputs of a drive; a robot whose drive has fewer has zeros for others.
    """

    def __init__(
        self, drives: Mapping[str, Drive], sampling_time: float, stream: Stream, still: Float
    ) -> None:
        """Take the drives by robots' names, the sampling time [s], and a source of random streams.

        still: the commands (m, n) of robots that stand still.

        Raises InputError for a dead time of more than a million sampling times.
        """
        for drive in drives.values():
            if drive.dead_time > MAX_DEAD_TIME * sampling_time:
                raise wrong(
                    f"{type(drive).__name__}.dead_time", drive.dead_time,
                    f"at most a million sampling times of {sampling_time:g} s",
                )  # fmt: skip
        self.dead_time = np.array([drive.dead_time for drive in drives.values()])
        self._sampling_time, self._stream = sampling_time, stream
        self._drives: Mapping[str, Drive] = {}
        self._noisy: list[_Team] = []
        self.renew(drives)
        self._reached = still  # the commands that actuators have got to
        self.cuts = Cuts(still)

    def renew(self, drives: Mapping[str, Drive]) -> None:
        """Take other drives of the same robots; those with noise must be the same as before.

        The actuators go on from the commands that they have got to.
        """
        if drives == self._drives:
            return
        column = {name: i for i, name in enumerate(drives)}
        before = self._noisy
        self._drives, self._teams = drives, []
        for drive, names in _grouped(drives):
            columns = np.array([column[name] for name in names])
            streams = [self._stream(f"drive {name}") for name in names] if drive.noise else []
            count = len(drive.rates)
            noise = _White(streams, count, self._sampling_time) if streams else None
            everybody = len(names) == len(drives)
            noise = next((team.noise for team in before if team.drive == drive), noise)
            self._teams.append(_Team(drive, None if everybody else columns, noise))
        self._rated = [team for team in self._teams if {*team.drive.rates} != {None}]
        self._noisy = [team for team in self._teams if team.noise is not None]

    @property
    def exact(self) -> bool:
        """Whether all follow their commands at once and without noise."""
        return not (self._rated or self._noisy)

    def limit(self, command: Float, last: Float) -> Float:
        """Limit commands (m, n), in place, to those that drives can follow after the last (m, n).

        Raises LawError if a drive of the user's fails.
        """
        _saturate(self._teams, command, self.cuts)
        if self._rated:
            for team in self._rated:
                with team.accelerating:
                    reached = team.drive.accelerate(
                        team.part(command), team.part(last), self._sampling_time
                    )
                    if reached is not command:
                        team.write(command, reached)
            _saturate(self._rated, command)  # rounding may have brought one beyond a limit again
        if not within(LARGEST, command):
            raise LawError(f"a drive saturates a command to {shown(command.tolist())}")
        return command

    def draw(self) -> None:
        """Draw the noise of the control step that begins."""
        for team in self._noisy:
            assert team.noise is not None
            team.normal = team.noise.draw()

    def drive(self, command: Float, duration: float) -> Iterator[tuple[float, Float]]:
        """Yield twists (3, n) that lead to commands (m, n), each with the seconds that it holds.

        Where actuators change at a bound, the time is cut into parts, with the mean of each. Raises
        LawError if a drive of the user's fails.
        """
        last = self._reached
        if not any((team.part(command) != team.part(last)).any() for team in self._rated):
            self._reached = command
            yield duration, self.twist(command)
            return
        h = duration / PARTS
        for k in range(PARTS):
            mean = command.copy()
            for team in self._rated:
                with team.ramping:
                    ramp = team.drive.ramp
                    team.write(mean, ramp(team.part(command), team.part(last), k * h, (k + 1) * h))
            yield h, self.twist(mean)
        self._reached = command.copy()
        for team in self._rated:
            with team.accelerating:
                accelerate = team.drive.accelerate
                gone = accelerate(team.part(command), team.part(last), duration)
                team.write(self._reached, gone)

    def reached(self) -> Float | None:
        """Return the twists (3, n) at the end of that time; None if no drive has ramps."""
        return self.twist(self._reached) if self._rated else None

    def twist(self, command: Float) -> Float:
        """Return the twists (3, n) for commands (m, n), with the drives' noise.

        Raises LawError if a drive of the user's fails.
        """
        twist = np.empty((3, command.shape[1]))
        for team in self._teams:
            mine = team.part(command)
            try:
                moved = (
                    team.drive.twist(mine)
                    if team.normal is None
                    else team.drive.noisy_twist(mine, team.normal)
                )
                for row, part in zip(twist, _rows(moved), strict=True):
                    row[team.columns] = part
                _check(twist[:, team.columns])
            except BaseException as error:
                team.moving.blame(error)
                raise
        return twist


class Cuts:
    """The commands far beyond the drives' bounds: how many of each robot, and the last ones."""

    def __init__(self, still: Float) -> None:
        """Take the commands (m, n) of robots that stand still."""
        self.count = np.zeros(still.shape[1], dtype=int)
        self.asked = still.copy()

    def note(self, team: _Team, asked: Float, done: Float) -> None:
        """Note which commands of some robots ask actuators for more than thrice what they do."""
        wanted, got = (np.abs(team.drive.actuators(each)).max(axis=0) for each in (asked, done))
        cut = wanted > 3.0 * got
        self.count[team.columns] += cut
        team.write(self.asked, np.where(cut, asked, team.part(self.asked)))


def _saturate(teams: list[_Team], command: Float, cuts: Cuts | None = None) -> None:
    """Limit commands (m, n), in place. cuts: notes those that were changed."""
    for team in teams:
        try:
            mine = team.part(command)
            limited = team.drive.saturate(mine)
            if cuts is not None and limited is not mine:
                cuts.note(team, mine, limited)
            if limited is not command:  # else it is there already
                team.write(command, limited)
                command[team.inputs :, team.columns] = 0.0
        except BaseException as error:
            team.saturating.blame(error)
            raise


def _rows(twist: Any) -> Any:
    """Return a twist that has three rows."""
    if not hasattr(twist, "__len__") or len(twist) != 3:
        raise LawError(f"twist returned {shown(twist)}: {ROWS}")
    return twist


def _check(twist: Float) -> None:
    """Check the twists (3, k) of some robots."""
    if not within(MAX_TWIST, twist):
        given = shown(twist.tolist())
        raise LawError(f"twist returned {given}: expected finite numbers, {MAX_TWIST:g} at most")


def _grouped(drives: Mapping[str, Drive]) -> list[tuple[Drive, list[str]]]:
    """Return each distinct drive with the names of its robots."""
    groups: list[tuple[Drive, list[str]]] = []
    for name, mine in drives.items():
        for drive, names in groups:
            if drive == mine and type(drive) is type(mine):
                names.append(name)
                break
        else:
            groups.append((mine, [name]))
    return groups


class _White:
    """The means (count, n) of white noise of density 1 over `duration` seconds, in turn.

    They are normal numbers with variance 1 / duration; each robot has a random stream of its own.
    """

    def __init__(self, streams: list[np.random.Generator], count: int, duration: float) -> None:
        self._streams, self._count, self._duration = streams, count, duration
        self._block: Float = np.empty((0, count, len(streams)))
        self._next = 0

    def draw(self) -> Float:
        """Return the next mean."""
        if self._next == len(self._block):
            blocks = [stream.standard_normal((BLOCK, self._count)) for stream in self._streams]
            self._block = np.stack(blocks, axis=-1) / sqrt(self._duration)
            self._next = 0
        self._next += 1
        return np.asarray(self._block[self._next - 1])
