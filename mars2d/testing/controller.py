"""Check a control law: its commands, its sight, and whether its runs are repeatable."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any

from mars2d.addons.base import Addon
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.subject import Subject
from mars2d.testing.trial import ControlLaw, small_world

KEEP = "Keep things in robot.memory, in variables of a generator, or in an add-on"


def check_controller(
    law: ControlLaw,
    *,
    sees: str = "full",
    sensors: Sequence[Sensor] = (),
    addons: Sequence[Addon] = (),
    scenario: Scenario | None = None,
    control: ControlLaw | None = None,
    team: bool | None = None,
    deadline: Deadline | None = None,
) -> None:
    """Try a control law; raise CheckError, which lists all that is wrong with it.

    For 50 control steps, the law drives the robots of a small world, which carry `sensors`, or
    those robots of a `scenario` that have it as their controller. sees: as ``Robot.sees`` or
    ``Scenario.sees``. control: the law of the scenario's team, if this is a robot's. team: whether
    it is the law of the team; by default, if its argument is called world or team. deadline: the
    limit of each control step.

    >>> check_controller(lambda robot: (0.2, 0.1 * robot.rng.normal()))
    """
    of_team = is_of_a_team(law) if team is None else team
    subject = Subject("law", law, "world.rng" if of_team else "robot.rng", KEEP)
    try:
        checks.function(subject.name, law, "the world" if of_team else "the robot")
    except InputError as error:
        subject.wrong(str(error))
        subject.conclude()
    own, placed = ["command "], scenario
    if of_team:
        placed, control = scenario or small_world(sensors, addons, None).replace(sees=sees), law
    elif scenario is None:
        placed = small_world(sensors, addons, law, sees)
    else:
        has_it = [code_of(robot.controller) == code_of(law) for robot in scenario.robots]
        robots = [
            robot.replace(controller=law) if has or not any(has_it) else robot
            for robot, has in zip(scenario.robots, has_it, strict=True)
        ]
        placed = scenario.replace(robots=robots)
        own = [f"command {robot.name}" for robot in robots if robot.controller is law]
    subject.check_runs(lambda: (placed, control), deadline, small=scenario is None, own=tuple(own))
    subject.conclude()


def is_of_a_team(law: ControlLaw) -> bool:
    """Return whether a law's argument has the name of a team law's: world, or team."""
    try:
        names = list(inspect.signature(law).parameters)
    except (TypeError, ValueError):
        return False
    return names[:1] in (["world"], ["team"])


def code_of(law: ControlLaw | None) -> Any:
    """Return what equal laws share, though perhaps loaded from a file twice: their code."""
    return None if law is None else getattr(inspect.unwrap(law), "__code__", law)
