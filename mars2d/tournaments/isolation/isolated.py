"""Run a match whose laws can't spoil it: each role's law has its own process and limits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from mars2d.core.errors import InputError, LawError
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.scenario import Scenario
from mars2d.tournaments.isolation.limits import LIMITS, Limits, Verdict
from mars2d.tournaments.isolation.observation import brief
from mars2d.tournaments.isolation.process import LawProcess
from mars2d.tournaments.isolation.source import law_code
from mars2d.world.loop import simulate
from mars2d.world.record import Record
from mars2d.world.simulation import Simulation
from mars2d.world.views import RobotView

Laws = Mapping[str, tuple[str | Path, Sequence[int]]]
"""The file of each role's law, and the robots that it drives."""


class Isolated(NamedTuple):
    """What came of a run with isolated laws.

    record: up to the control step in which a law failed, if one did. verdicts: on the laws that
    failed, by role. output: the first 64 kB that each law has printed, by role.
    """

    record: Record
    verdicts: dict[str, Verdict]
    output: dict[str, str]


def run_isolated(
    experiment: Experiment,
    laws: Laws,
    limits: Limits = LIMITS,
    code: Mapping[str, Mapping[Path, bytes]] | None = None,
) -> Isolated:
    """Run an experiment to its end, with each of these laws in a process of its own.

    laws: the file of each role's law, and the robots that it drives, by index. code: the contents
    of each role's files, see `law_code`; by default they are read now. A law that fails ends the
    run; all laws that fail in the same control step get verdicts. Raises InputError for unknown
    robots and for robots with two laws, and LawError where other code of the experiment fails.
    """
    scenario, seed = experiment.scenario, experiment.seed or 0
    drivers = _drivers(scenario, laws)
    files = {role: Path(file).absolute() for role, (file, _) in laws.items()}
    code = code or {role: law_code(file) for role, file in files.items()}
    processes: dict[str, LawProcess] = {}
    verdicts: dict[str, Verdict] = {}
    asked = -1

    def judge(time: float) -> None:
        """Note the verdicts on laws that have failed, and raise them as a LawError."""
        for role, process in processes.items():
            if process.fault is not None:
                verdicts[role] = Verdict(*process.fault, time)
        if verdicts:
            raise LawError("; ".join(f"{role}: {found.text}" for role, found in verdicts.items()))

    def ask_all(world: Simulation) -> None:
        """Ask one law after the other for its commands, once a control step."""
        nonlocal asked
        if asked != world.iteration:
            asked = world.iteration
            for process in processes.values():
                if process.fault is None:
                    process.ask(world)
            judge(world.time)

    def asking(robot: int) -> Callable[[RobotView], tuple[float, float]]:
        def control(view: RobotView) -> tuple[float, float]:
            world = view._world
            ask_all(world)
            command = processes[drivers[robot]].command(world, robot)
            judge(world.time)
            return command

        return control

    with ExitStack() as running:
        for role, (_, robots) in laws.items():
            briefing = brief(scenario, role, files, code, robots, seed, limits)
            processes[role] = running.enter_context(LawProcess(briefing))
            processes[role].load()
        guarded = [
            robot.replace(controller=asking(i)) if i in drivers else robot
            for i, robot in enumerate(scenario.robots)
        ]
        isolated = replace(experiment, scenario=scenario.replace(robots=guarded))
        try:
            record = simulate(isolated).record
        except LawError as error:
            if not verdicts or error.record is None:
                raise
            record = error.record
    output = {role: process.printed for role, process in processes.items() if process.printed}
    return Isolated(record, verdicts, output)


def _drivers(scenario: Scenario, laws: Laws) -> dict[int, str]:
    """Return the role that drives each robot; InputError for two roles or an unknown robot."""
    drivers: dict[int, str] = {}
    for role, (_, robots) in laws.items():
        for robot in robots:
            index = scenario.index_of(f"laws[{role!r}]", robot)
            if index in drivers:
                name = scenario.robots[index].name
                raise InputError(f"laws: {name} has those of {drivers[index]} and {role}")
            drivers[index] = role
    return drivers
