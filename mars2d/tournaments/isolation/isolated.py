"""Run a match whose laws can't spoil it: each role's law has its own process and limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from mars2d.core.errors import InputError, LawError
from mars2d.scenario.experiment import Experiment
from mars2d.tournaments.isolation.limits import LIMITS, Limits, Verdict
from mars2d.tournaments.isolation.observation import brief
from mars2d.tournaments.isolation.process import LawProcess
from mars2d.tournaments.isolation.source import law_code
from mars2d.world.loop import simulate
from mars2d.world.record import Record
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
    driven = [
        scenario.index_of(f"laws[{role!r}]", robot)
        for role, (_, robots) in laws.items()
        for robot in robots
    ]
    if twice := [scenario.robots[i].name for i in driven if driven.count(i) > 1]:
        raise InputError(f"laws: {twice[0]} has two")
    files = {role: Path(file).absolute() for role, (file, _) in laws.items()}
    code = code or {role: law_code(file) for role, file in files.items()}
    processes: dict[str, LawProcess] = {}
    verdicts: dict[str, Verdict] = {}
    commands: dict[int, tuple[float, ...]] = {}
    asked = -1

    def control(view: RobotView) -> tuple[float, ...]:
        """Return the command of a robot; once a control step, ask one law after the other."""
        nonlocal asked
        world = view._world
        if asked != world.iteration:
            asked = world.iteration
            for role, process in processes.items():
                if process.fault is None:
                    commands.update(process.command(world))
                if process.fault is not None:
                    verdicts[role] = Verdict(*process.fault, world.time)
        if verdicts:
            raise LawError("; ".join(f"{role}: {found.text}" for role, found in verdicts.items()))
        return commands[view.index]

    with ExitStack() as running:
        folder = running.enter_context(TemporaryDirectory(prefix="mars2d-"))
        for role, (_, robots) in laws.items():
            briefing = brief(scenario, role, files, code, robots, seed, limits)
            output = Path(folder) / str(len(processes))
            processes[role] = running.enter_context(LawProcess(briefing, output))
            processes[role].load()
        own = [
            control if i in driven else each.controller for i, each in enumerate(scenario.robots)
        ]
        try:
            record = simulate(replace(experiment, scenario=scenario.with_laws(own))).record
        except LawError as error:
            if not verdicts or error.record is None:
                raise
            record = error.record
    printed = {role: process.printed for role, process in processes.items() if process.printed}
    return Isolated(record, verdicts, printed)
