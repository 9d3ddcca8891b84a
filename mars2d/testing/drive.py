"""Check a drive: the shapes of its commands and twists, its limits, and that it keeps nothing."""

from __future__ import annotations

from typing import Any

import numpy as np

from mars2d.bodies.drives.base import Drive
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import shown
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
    """Try a drive's methods; return a small world, whose robots have it if it is sound."""
    for method in ("saturate", "twist"):
        every = _called(drive, subject, method, COMMANDS)
        if not subject.sound:
            break
        alone = [_called(drive, subject, method, COMMANDS[:, i : i + 1]) for i in range(5)]
        if subject.sound and not np.allclose(np.hstack(alone), every, rtol=1e-9, atol=1e-12):
            subject.wrong(
                f"{subject.name}.{method} gives a robot another result among others than alone: "
                "each column belongs to a robot, and must not depend on the others"
            )
    limited = drive.saturate(COMMANDS.copy())
    if subject.sound and not np.allclose(drive.saturate(limited.copy()), limited):
        subject.wrong(f"{subject.name}.saturate limits a command again that is limited already")
    scenario = small_world()
    if subject.sound:
        robots = [robot.replace(drive=drive) for robot in scenario.robots]
        scenario = scenario.replace(robots=robots)
    return scenario, None


def _called(drive: Drive, subject: Subject, method: str, commands: Any) -> Any:
    """Return what a method makes of commands (2, n); report what it should not be."""
    given, where, function = commands.copy(), f"{subject.name}.{method}", getattr(drive, method)
    with called(where, function):
        result = function(given)
    if not np.array_equal(given, commands):
        subject.wrong(f"{where} changes the array that it is given: work on a copy")
    shape = (3 if method == "twist" else 2, commands.shape[1])
    if np.shape(result) != shape:
        subject.wrong(
            f"{where} returned {shown(result)} for commands of shape {commands.shape}: expected an "
            f"array of shape {shape}, a column for each robot"
        )
    elif not np.isfinite(result).all():
        subject.wrong(f"{where} returned nan or inf for finite commands")
    return result
