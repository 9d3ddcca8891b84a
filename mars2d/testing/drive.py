"""Check a drive: the shapes of its commands and twists, its limits, and that it keeps nothing."""

from __future__ import annotations

import numpy as np

from mars2d.bodies.drives.base import Drive
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError, shown
from mars2d.core.usercode import called
from mars2d.testing.finding import Finding
from mars2d.testing.subject import Subject
from mars2d.testing.trial import Placed, small_world

COMMANDS = np.array([[0.0, 0.3, -0.2, 5.0, -7.0], [0.0, 0.4, 1.0, -9.0, 0.0]])

KEEP = "A drive is the same at each step and for all robots that have it, and keeps nothing"


def check_drive(drive: Drive, *, deadline: Deadline | None = None) -> tuple[Finding, ...]:
    """Try a drive; return hints, and raise CheckError, which lists all that is wrong with it.

    Its methods are called with the commands of several robots at once and of each one alone; then
    it drives robots in a small world. deadline: the limit of each control step.

    >>> from mars2d import Unicycle
    >>> check_drive(Unicycle())
    ()
    """
    checks.instance(Drive, "Unicycle()")("check_drive(drive)", drive)
    subject = Subject("drive", drive, "nothing: the field `noise` is there for that", KEEP)
    if type(drive).twist is Drive.twist:
        subject.wrong(
            f"{subject.name} has no method twist: write twist(self, command), which makes "
            "of commands (2, n) the velocities (3, n) that they ask for"
        )
    elif subject.check_part(drive, Drive):
        subject.check_runs(lambda: _placed(drive, subject), deadline, small=True)
    return subject.hints()


def _placed(drive: Drive, subject: Subject) -> Placed:
    """Try a drive's methods; return a small world, whose robots have it."""
    for method in ("saturate", "twist"):
        function, where = getattr(drive, method), f"{subject.name}.{method}"
        with called(where, function):
            every = function(COMMANDS.copy())
            alone = [function(COMMANDS[:, i : i + 1].copy()) for i in range(COMMANDS.shape[1])]
        shape = (3 if method == "twist" else 2, COMMANDS.shape[1])
        if np.shape(every) != shape:
            raise InputError(
                f"{where} returned {shown(every)} for commands of shape {COMMANDS.shape}: expected "
                f"an array of shape {shape}, a column for each robot"
            )
        if not np.allclose(np.hstack(alone), every, rtol=1e-9, atol=1e-12):
            subject.wrong(
                f"{where} gives a robot another result among others than alone: each column "
                "belongs to a robot, and must not depend on the others"
            )
    limited = drive.saturate(COMMANDS.copy())
    if not np.allclose(drive.saturate(limited.copy()), limited):
        subject.wrong(f"{subject.name}.saturate limits a command again that is limited already")
    scenario = small_world()
    return scenario.replace(robots=[robot.replace(drive=drive) for robot in scenario.robots]), None
