"""Check a control law: its commands, its sight, seeds, and where it keeps state."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from mars2d.addons.base import Addon
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError, Late, LawError
from mars2d.core.usercode import name_of
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.common import check_repeatable, run_ended
from mars2d.testing.finding import Finding, Noted, Notes, Report, judge, said
from mars2d.testing.state import Places
from mars2d.testing.trial import Run, Trial, small_world
from mars2d.world.laws import Law, robot_command, team_command
from mars2d.world.world import World

ControlLaw = Callable[[Any], Any]

KEEP = {
    False: "Keep such things in robot.memory, or in variables of a generator",
    True: "Keep such things in variables of a generator, or in an add-on",
}

STREAM = {False: "robot.rng, the robot's own stream", True: "world.rng, the stream of the law"}


def check_controller(
    law: ControlLaw,
    *,
    sees: str = "full",
    sensors: Sequence[Sensor] = (),
    addons: Sequence[Addon] = (),
    scenario: Scenario | None = None,
    team: bool | None = None,
) -> None:
    """Try a control law, and raise CheckError, which lists everything that is wrong with it.

    For 50 control steps, the law drives the robots of a small world, which carry `sensors`, or
    those robots of a `scenario` that have it as their controller. sees: as ``Robot.sees`` or
    ``Scenario.sees``. team: whether it is the law of the team; by default, if its argument is
    called world or team.

    >>> check_controller(lambda robot: (0.2, 0.1 * robot.rng.normal()))
    """
    found = controller_findings(
        law, sees=sees, sensors=sensors, addons=addons, scenario=scenario, team=team
    )
    judge(f"law {name_of(law)}", found)


def is_of_a_team(law: ControlLaw) -> bool:
    """Return whether a law's argument has the name of a team law's: world, or team."""
    try:
        names = list(inspect.signature(law).parameters)
    except (TypeError, ValueError):
        return False
    return names[:1] in (["world"], ["team"])


def controller_findings(
    law: ControlLaw,
    *,
    sees: str = "full",
    sensors: Sequence[Sensor] = (),
    addons: Sequence[Addon] = (),
    scenario: Scenario | None = None,
    control: ControlLaw | None = None,
    team: bool | None = None,
    deadline: Deadline | None = None,
) -> tuple[Finding, ...]:
    """Return the findings of `check_controller`, including hints.

    control: the law of the scenario's team, if the law is a robot's. deadline: the limit of each
    control step.
    """
    of_team = is_of_a_team(law) if team is None else team
    report = Report()
    try:
        checks.law(name_of(law), law, "the world" if of_team else "the robot")
    except InputError as error:
        report.wrong(str(error))
        return report.findings
    subject = _Subject(law, report, of_team)
    subject.notes.small_world = scenario is None
    places = Places(law)
    with deadline or Deadline() as limit:
        # A law is tried only in its own scenario: elsewhere it might lack something.
        run, looked = Run(), subject.look
        try:
            if scenario is None:
                tried = _place(subject.witness, of_team, sees, sensors, addons)
            else:
                tried = subject.placed(scenario)
            trial = Trial(tried, subject.witness if of_team else control, limit, looked=looked)
            run = trial.run()
        except InputError as error:
            run.error = error
        except Late:
            run.late, run.patience = limit.arrived(), limit.patience
        if run_ended(run, subject.notes):
            subject.conclude()
            check_repeatable(trial, run, places, subject.notes, subject.commands(tried))
    return report.findings


def _place(
    law: ControlLaw, of_team: bool, sees: str, sensors: Sequence[Sensor], addons: Sequence[Addon]
) -> Scenario:
    """Return the small world for the trial of a law."""
    if not of_team:
        return small_world(sensors, addons, law, sees)
    scenario = small_world(sensors, addons, law)
    robots = [robot.replace(controller=None) for robot in scenario.robots]
    return scenario.replace(robots=robots, sees=sees)


class _Subject:
    """The law on trial, and the observations so far."""

    def __init__(self, law: ControlLaw, report: Report, of_team: bool) -> None:
        self.law, self.report, self.of_team = law, report, of_team
        self.notes = Notes(name_of(law), report, STREAM[of_team], KEEP[of_team])
        self.witness = _Witness(self)
        self._world: World | None = None
        self._asked: dict[int, np.ndarray] = {}
        self.steps = self.limited = self.moved = 0
        self._example = ""
        self.returned_at: float | None = None

    def placed(self, scenario: Scenario) -> Scenario:
        """Return a scenario in which the witness replaces the law as a controller."""
        if self.of_team:
            return scenario
        own = [robot.controller is not None and _same(robot.controller, self.law)
               for robot in scenario.robots]  # fmt: skip
        robots = [
            robot.replace(controller=self.witness) if mine or not any(own) else robot
            for robot, mine in zip(scenario.robots, own, strict=True)
        ]
        return scenario.replace(robots=robots)

    def commands(self, scenario: Scenario) -> tuple[str, ...]:
        """Return the names in `Run.rows` for which the law is responsible."""
        mine = [r for r in scenario.robots if (r.controller is None) == self.of_team
                and r.controller in (None, self.witness)]  # fmt: skip
        return tuple(f"command {robot.name}" for robot in mine)

    def checked(self, subject: Any, value: Any) -> Any:
        """Return a valid command; report an invalid one, and return that to stand still."""
        law = Law(self.law, subject)
        try:
            if self.of_team:
                command = team_command(value, len(subject.robots), law.refuse)
                for i, column in enumerate(command.T):
                    self._asked[i] = column.copy()
            else:
                self._asked[subject.index] = np.array(robot_command(value, law.refuse))
        except LawError as error:
            self.report.wrong(said(error, subject.time))
            return self.still(subject)
        return value

    def still(self, subject: Any) -> Any:
        """Return the command to stand still."""
        return np.zeros((2, len(subject.robots))) if self.of_team else (0.0, 0.0)

    def look(self, world: World) -> None:
        """Compare the commands asked for with those issued, after a control step."""
        for i, asked in self._asked.items():
            issued = world.command[:, i]
            self.steps += 1
            self.moved += bool(asked.any())
            if np.abs(issued - asked).max() > 1e-9 * (1 + np.abs(asked).max()):
                self.limited += 1
                self._example = f"asked for {_pair(asked)}, done {_pair(issued)}"
        self._asked = {}

    def conclude(self) -> None:
        """Hint at behaviour that is rarely intended."""
        name = self.notes.name
        if self.returned_at is not None:
            self.report.hint(
                f"{name} is a generator that ended, at {self.returned_at:g} s: from then on its "
                "robots stand still; a law that goes on has a `while True:` round it"
            )
        elif self.steps and not self.moved and self.report.sound:
            self.report.hint(f"{name} commanded nothing but zeros in the whole trial")
        elif self.steps and self.limited == self.steps:
            self.report.hint(
                f"{name} always asks for more than the drive can do ({self._example}): what it "
                "does then depends on the limits alone"
            )


class _Witness:
    """A law that calls another one and checks its commands."""

    def __init__(self, subject: _Subject) -> None:
        self._subject = subject
        functools.update_wrapper(self, subject.law, assigned=("__doc__",), updated=())
        self.__name__ = subject.notes.name

    def __call__(self, subject: Any) -> Any:
        """Call the law; report an exception, and then let its robots stand still."""
        mine, whose = self._subject, str(getattr(subject, "name", ""))
        try:
            with mine.notes.calling("", mine.law, subject.time, whose):
                result = mine.law(subject)
        except Noted:
            return mine.still(subject)
        if inspect.isgenerator(result):
            return self._running(result, subject)
        return mine.checked(subject, result)

    def _running(self, law: Iterator[Any], subject: Any) -> Iterator[Any]:
        mine, whose = self._subject, str(getattr(subject, "name", ""))
        while True:
            try:
                with mine.notes.calling("", mine.law, subject.time, whose):
                    value = next(law, _ENDED)
            except Noted:
                return
            if value is _ENDED:
                mine.returned_at = subject.time
                return
            yield mine.checked(subject, value)


_ENDED = object()


def _same(one: Any, other: Any) -> bool:
    """Return whether two laws are the same code, though perhaps loaded from a file twice."""
    codes = [getattr(inspect.unwrap(law), "__code__", None) for law in (one, other)]
    return one is other or (codes[0] is not None and codes[0] == codes[1])


def _pair(command: Any) -> str:
    return f"({command[0]:.3g}, {command[1]:.3g})"
