"""Check a drive: the shapes of its commands and twists, its limits, and that it has no state."""

from __future__ import annotations

from typing import Any

import numpy as np

from mars2d.bodies.drives.base import Drive
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError, shown
from mars2d.scenario.robot import Robot
from mars2d.testing.common import check_fields, check_methods, check_places, is_own, run_ended
from mars2d.testing.finding import Finding, Noted, Notes, Report, judge
from mars2d.testing.state import Places
from mars2d.testing.trial import Run, Trial, bystander, small_world

METHODS = {
    "twist": (("command",), 3),
    "saturate": (("command",), 2),
    "actuators": (("command",), 2),
    "command_for": (("actuators",), 2),
    "accelerate": (("command", "last", "duration"), 2),
    "ramp": (("command", "last", "start", "end"), 2),
    "disturb": (("command", "normal"), 2),
    "noisy_twist": (("command", "normal"), 3),
}
"""The methods that a drive can define: their arguments, and the rows of the result."""

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
    places = Places(type(drive))
    check_fields(drive, Drive, subject.notes)
    if subject.can_be_called():
        with deadline or Deadline() as limit:
            run = Run()
            try:
                subject.try_methods()
                if subject.report.sound:
                    run = subject.trial(limit).run()
            except InputError as error:
                run.error = error
            run_ended(run, subject.notes)
        for place in places.changed():
            subject.report.wrong(f"{subject.notes.name} keeps something in {place}: {KEEP}")
    check_places(places, subject.notes)
    return subject.report.findings


KEEP = "a drive is the same at each step and for all robots that have it, and keeps nothing"


class _Subject:
    """The drive on trial, and the observations so far."""

    def __init__(self, drive: Drive) -> None:
        self.drive, self.kind = drive, type(drive)
        self.report = Report()
        own = "nothing: the field `noise` is there for that"
        self.notes = Notes(self.kind.__name__, self.report, own, KEEP.capitalize())

    def can_be_called(self) -> bool:
        """Report methods that are missing or can't be called; return whether it can be tried."""
        if not is_own(self.drive, "twist", Drive):
            self.report.wrong(
                f"{self.notes.name} has no method twist: write twist(self, command), which makes "
                "of commands (2, n) the velocities (3, n) that they ask for"
            )
            return False
        methods = {name: arguments for name, (arguments, _) in METHODS.items()}
        return check_methods(self.drive, Drive, methods, self.notes)

    def try_methods(self) -> None:
        """Call each method with several commands at once, and with each one alone."""
        for method, (_, rows) in METHODS.items():
            if not is_own(self.drive, method, Drive):
                continue
            every = self._called(method, rows, COMMANDS)
            if every is None:
                continue
            alone = [self._called(method, rows, COMMANDS[:, i : i + 1]) for i in range(5)]
            if any(one is None or not np.allclose(one[:, 0], every[:, i], rtol=1e-9, atol=1e-12)
                   for i, one in enumerate(alone)):  # fmt: skip
                self.report.wrong(
                    f"{self.notes.name}.{method} gives a robot another result among others than "
                    "alone: each column belongs to a robot, and must not depend on the others"
                )
        if not self.report.sound:
            return
        limited = self.drive.saturate(COMMANDS)
        if not np.allclose(self.drive.saturate(limited), limited):
            self.report.wrong(
                f"{self.notes.name}.saturate limits a command again that it has limited already"
            )

    def _called(self, method: str, rows: int, commands: Any) -> Any:
        given = commands.copy()
        still = (0 * given,)
        more = {
            "accelerate": (0 * given, 0.1), "ramp": (0 * given, 0.0, 0.1),
            "disturb": still, "noisy_twist": still,
        }.get(method, ())  # fmt: skip
        function = getattr(self.drive, method)
        try:
            with self.notes.calling(method, function, None):
                result = function(given, *more)
        except Noted:
            return None
        name, shape = f"{self.notes.name}.{method}", (rows, commands.shape[1])
        if not np.array_equal(given, commands):
            self.report.wrong(f"{name} changes the array that it is given: work on a copy")
        try:
            values = np.asarray(result)
        except ValueError:  # rows of different lengths
            values = np.empty(0, dtype=object)
        if values.dtype.kind not in "bifu" or values.shape != shape:
            what = shown(result) if values.dtype.kind not in "bifu" else f"shape {values.shape}"
            self.report.wrong(
                f"{name} returned {what} for commands of shape {commands.shape}: expected an array "
                f"of shape {shape}, a column for each robot"
            )
            return None
        if not np.isfinite(values).all():
            self.report.wrong(f"{name} returned nan or inf for finite commands")
            return None
        return values

    def trial(self, deadline: Deadline) -> Trial:
        """Return a small world whose robots have this drive."""
        scenario = small_world()
        robot = Robot(drive=self.drive, controller=bystander)
        robots = [robot.at(*each.pose) for each in scenario.robots]
        return Trial(scenario.replace(robots=robots), None, deadline)
