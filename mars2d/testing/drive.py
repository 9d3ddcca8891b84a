"""Check a drive: the shapes of its commands and twists, its limits, and that it keeps nothing."""

from __future__ import annotations

from typing import Any

import numpy as np

from mars2d.bodies.drives.base import Drive
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import shown
from mars2d.core.usercode import called
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.testing.finding import Finding, judge
from mars2d.testing.subject import Subject, own_methods
from mars2d.testing.trial import bystander, small_world

COLUMNS = (
    "twist",
    "saturate",
    "actuators",
    "command_for",
    "accelerate",
    "ramp",
    "disturb",
    "noisy_twist",
)
"""The methods that make a column for each robot of the columns that they are given."""

COMMANDS = np.array([[0.0, 0.3, -0.2, 5.0, -7.0], [0.0, 0.4, 1.0, -9.0, 0.0]])


def check_drive(drive: Drive) -> None:
    """Try a drive, and raise CheckError, which lists everything that is wrong with it.

    Its methods are called with the commands of several robots at once and of each one alone; then
    it drives robots in a small world.

    >>> from mars2d import Unicycle
    >>> check_drive(Unicycle())
    """
    judge(f"drive {type(drive).__name__}", drive_findings(drive))


def drive_findings(drive: Drive, *, deadline: Deadline | None = None) -> tuple[Finding, ...]:
    """Return the findings of `check_drive`, including hints. deadline: the limit of a step."""
    checks.instance(Drive, "Unicycle()")("check_drive(drive)", drive)
    subject = _Subject(drive)
    if type(drive).twist is Drive.twist:
        subject.report.wrong(
            f"{subject.name} has no method twist: write twist(self, command), which makes "
            "of commands (2, n) the velocities (3, n) that they ask for"
        )
    elif subject.check_methods(drive, Drive) and subject.check_fields(drive, Drive):
        with deadline or Deadline() as limit:
            done = subject.first_run(subject.placed, limit, small=True)
            if done is not None and subject.report.sound:
                subject.check_repeatable(*done, ("",))
    return subject.report.findings


class _Subject(Subject):
    """The drive on trial."""

    def __init__(self, drive: Drive) -> None:
        self.drive = drive
        keep = "A drive is the same at each step and for all robots that have it, and keeps nothing"
        stream = "nothing: the field `noise` is there for that"
        super().__init__(type(drive).__name__, stream, keep)

    def placed(self) -> tuple[Scenario, None]:
        """Try its methods; return a small world, whose robots have the drive if it is sound."""
        self._try_methods()
        scenario, drive = small_world(), self.drive if self.report.sound else Robot().drive
        robot = Robot(drive=drive, controller=bystander)
        return scenario.replace(robots=[robot.at(*r.pose) for r in scenario.robots]), None

    def _try_methods(self) -> None:
        """Call each method with several commands at once, and with each one alone."""
        for method in set(COLUMNS).intersection(own_methods(self.drive, Drive)):
            every = self._called(method, COMMANDS)
            alone = [self._called(method, COMMANDS[:, i : i + 1]) for i in range(5)]
            if not self.report.sound:
                return
            if not np.allclose(np.hstack(alone), every, rtol=1e-9, atol=1e-12):
                self.report.wrong(
                    f"{self.name}.{method} gives a robot another result among others than alone: "
                    "each column belongs to a robot, and must not depend on the others"
                )
        limited = self.drive.saturate(COMMANDS.copy())
        if not np.allclose(self.drive.saturate(limited.copy()), limited):
            self.report.wrong(
                f"{self.name}.saturate limits a command again that it has limited already"
            )

    def _called(self, method: str, commands: Any) -> Any:
        """Return what a method makes of commands (2, n); report what it should not be."""
        given, still = commands.copy(), 0 * commands
        more: tuple[Any, ...] = {
            "accelerate": (still, 0.1), "ramp": (still, 0.0, 0.1),
            "disturb": (still,), "noisy_twist": (still,),
        }.get(method, ())  # fmt: skip
        where, function = f"{self.name}.{method}", getattr(self.drive, method)
        with self.calling(where), called(where, function):
            result = function(given, *more)
        if not np.array_equal(given, commands):
            self.report.wrong(f"{where} changes the array that it is given: work on a copy")
        shape = (3 if method.endswith("twist") else 2, commands.shape[1])
        try:
            values = np.asarray(result, dtype=float)
        except (TypeError, ValueError):  # text, or rows of different lengths
            values = np.empty(0)
        if values.shape != shape:
            what = f"shape {values.shape}" if values.size else shown(result)
            self.report.wrong(
                f"{where} returned {what} for commands of shape {commands.shape}: expected an "
                f"array of shape {shape}, a column for each robot"
            )
        elif not np.isfinite(values).all():
            self.report.wrong(f"{where} returned nan or inf for finite commands")
        return values
