"""Check a control law: its commands, its sight, and whether its runs are repeatable."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Sequence
from typing import Any

from mars2d.addons.base import Addon
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError
from mars2d.core.usercode import name_of
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.finding import Finding, judge
from mars2d.testing.subject import ControlLaw, Subject
from mars2d.testing.trial import small_world

KEEP = {
    False: "Keep things in robot.memory, or in variables of a generator",
    True: "Keep things in variables of a generator, or in an add-on",
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
    name = name_of(law)
    subject = Subject(name, STREAM[of_team], KEEP[of_team])
    try:
        checks.function(name, law, "the world" if of_team else "the robot")
    except InputError as error:
        subject.report.wrong(str(error))
        return subject.report.findings
    witness = _watched(law, subject)
    if scenario is None:
        placed = small_world(sensors, addons, witness, "full" if of_team else sees)
        if of_team:
            robots = [robot.replace(controller=None) for robot in placed.robots]
            placed = placed.replace(robots=robots, sees=sees)
    else:
        placed = scenario if of_team else _with_law(scenario, law, witness)
    team_law = witness if of_team else control
    with deadline or Deadline() as limit:
        done = subject.first_run(lambda: (placed, team_law), limit, small=scenario is None)
        if done is not None:
            mine = None if of_team else witness
            robots = [robot for robot in placed.robots if robot.controller is mine]
            own = tuple(f"command {robot.name}" for robot in robots)
            subject.check_repeatable(*done, own)
    return subject.report.findings


def _watched(law: ControlLaw, subject: Subject) -> ControlLaw:
    """Return a law that does the same, and reports where it draws at random, and where it ends."""

    def running(steps: Iterator[Any], whose: Any) -> Iterator[Any]:
        while True:
            with subject.calling(subject.name):
                command = next(steps, steps)
            if command is steps:
                subject.report.hint(
                    f"{subject.name} is a generator that ended, at {whose.time:g} s: from then on "
                    "its robots stand still; a law that goes on has a `while True:` round it"
                )
                return
            yield command

    def witness(whose: Any) -> Any:
        with subject.calling(subject.name):
            result = law(whose)
        return running(result, whose) if inspect.isgenerator(result) else result

    witness.__name__, witness.__doc__ = subject.name, law.__doc__
    witness.__wrapped__ = law  # type: ignore[attr-defined]
    return witness


def _with_law(scenario: Scenario, law: ControlLaw, witness: ControlLaw) -> Scenario:
    """Return a scenario in which the witness replaces a law, or that of all robots if none has it.

    The same code is the same law, though perhaps loaded from a file twice.
    """

    def code(law: ControlLaw | None) -> Any:
        return None if law is None else getattr(inspect.unwrap(law), "__code__", law)

    mine = [code(robot.controller) == code(law) for robot in scenario.robots]
    robots = [
        robot.replace(controller=witness) if own or not any(mine) else robot
        for robot, own in zip(scenario.robots, mine, strict=True)
    ]
    return scenario.replace(robots=robots)
