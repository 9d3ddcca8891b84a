"""Check a drive: the shapes of its commands and twists, its limits, and that it keeps nothing."""

from __future__ import annotations

from typing import Any

import numpy as np

from mars2d.bodies.drives.base import Drive
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError, shown
from mars2d.core.usercode import called
from mars2d.testing.subject import Subject
from mars2d.testing.trial import Placed, small_world

COMMANDS = np.array(
    [
        [0.0, 0.3, -0.2, 5.0, -7.0],
        [0.0, 0.4, 1.0, -9.0, 0.0],
        [0.0, -0.5, 0.8, 6.0, 0.1],
        [0.0, 0.2, 0.0, -8.0, 3.0],
    ]
)

KEEP = "A drive is the same at each step and for all robots that have it, and keeps nothing"


def check_drive(drive: Drive, *, deadline: Deadline | None = None) -> None:
    """Try a drive; raise CheckError, which lists all that is wrong with it.

    Its methods are called with the commands of several robots at once and of each one alone; then
    it drives robots in a small world. deadline: the limit of each control step.

    >>> from mars2d import Unicycle
    >>> check_drive(Unicycle())
    """
    checks.instance(Drive, "Unicycle()")("check_drive(drive)", drive)
    subject = Subject("drive", drive, "nothing: the field `noise` is there for that", KEEP)
    if type(drive).twist is Drive.twist:
        subject.wrong(
            f"{subject.name} has no method twist: write twist(self, command), which makes "
            "of commands (m, n) the velocities (3, n) that they ask for"
        )
    elif subject.check_part(drive, Drive):
        subject.check_runs(lambda: _placed(drive, subject), deadline, small=True)
    subject.conclude()


def _placed(drive: Drive, subject: Subject) -> Placed:
    """Try a drive's methods; return a small world, whose robots have it."""
    commands = COMMANDS[: len(drive.inputs)]
    for method in ("saturate", "twist"):
        function, where = getattr(drive, method), f"{subject.name}.{method}"
        with called(where, function):
            every = _rows(function(commands.copy()), commands.shape[1])
            alone = [_rows(function(each[:, None].copy()), 1) for each in commands.T]
        shape = (3 if method == "twist" else len(commands), commands.shape[1])
        if np.shape(every) != shape:
            raise InputError(
                f"{where} returned {shown(every)} for commands of shape {commands.shape}: expected "
                f"an array of shape {shape}, a column for each robot"
            )
        if not np.allclose(np.hstack(alone), every, rtol=1e-9, atol=1e-12):
            subject.wrong(
                f"{where} gives a robot another result among others than alone: each column "
                "belongs to a robot, and must not depend on the others"
            )
    limited = drive.saturate(commands.copy())
    if not np.allclose(drive.saturate(limited.copy()), limited):
        subject.wrong(f"{subject.name}.saturate limits a command again that is limited already")
    scenario = small_world()
    return scenario.replace(robots=[robot.replace(drive=drive) for robot in scenario.robots]), None


def _rows(result: Any, n: int) -> Any:
    """Return rows as an array (k, n), some of which may be one number for all robots."""
    if isinstance(result, tuple) and all(np.shape(row) in ((), (n,)) for row in result):
        return np.array([np.broadcast_to(row, n) for row in result])
    return result
