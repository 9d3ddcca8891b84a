"""Laws that can't spoil a match: each role's in a process of its own, with limits and verdicts."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self, cast

from mars2d.core.errors import InputError, LawError
from mars2d.core.streams import check_seed
from mars2d.scenario.scenario import Scenario
from mars2d.study.isolation.briefing import brief
from mars2d.study.isolation.ears import Ears
from mars2d.study.isolation.limits import Limits, Verdict
from mars2d.study.isolation.process import LawProcess
from mars2d.world.simulation import Simulation
from mars2d.world.views import RobotView

__all__ = ["Guard", "Limits", "Verdict"]

PATIENCE = 1.0
"""How long one law may go on talking while another's time is over, seconds."""


class Guard:
    """Runs the laws of a match each in a process of its own, and says of each that fails why.

    It is a context manager, and for one run. A law that fails raises a LawError from its robot's
    controller, which breaks the run off; all laws that fail in the same control step have verdicts
    then. It is no sandbox: a law may read and write files, for instance.

    scenario: what is to be run, by `World` or `simulate`: its robots ask the isolated laws.
    verdicts: by role, of those that have failed.
    """

    def __init__(
        self,
        scenario: Scenario,
        laws: Mapping[str, tuple[Path, Sequence[int]]],
        seed: int,
        limits: Limits = Limits(),  # noqa: B008 - it is frozen
    ) -> None:
        """Take the scenario, by role the law's file and its robots' indices, and the run's seed.

        Raises InputError for robots that are not there, or that two laws would drive.
        """
        self._drivers = _drivers(scenario, laws)
        self._laws = {
            role: (Path(file).absolute(), robots) for role, (file, robots) in laws.items()
        }
        self._seed, self._limits = check_seed(seed), limits
        self._original = scenario
        robots = [
            robot.replace(controller=self._asking(i)) if i in self._drivers else robot
            for i, robot in enumerate(scenario.robots)
        ]
        self.scenario = scenario.replace(robots=robots)
        self.verdicts: dict[str, Verdict] = {}
        self._processes: dict[str, LawProcess] = {}
        self._ears: Ears | None = None
        self._world: Simulation | None = None
        self._iteration = -1

    @property
    def output(self) -> dict[str, str]:
        """What each law has printed so far, by role: the first 64 kB."""
        return {role: process.printed for role, process in self._processes.items()}

    def __enter__(self) -> Self:
        """Start the processes and load the laws, side by side."""
        if self._processes:
            raise InputError("a Guard is for one run: make another one")
        briefings = brief(self._original, self._laws, self._seed, self._limits)
        count = len(self._original.robots), len(self._original.props)
        ears = self._ears = Ears()
        try:
            for role, briefing in briefings.items():
                process = self._processes[role] = LawProcess(briefing, *count)
                ears.add(process.channel, process.receive)
                ears.add(process.output, process.drain)
            for process in self._processes.values():
                process.brief()
            self._wait()
        except BaseException:
            self._end()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._end()

    def _end(self) -> None:
        """End all processes and all that they have started."""
        self._ears = None
        with contextlib.ExitStack() as all_of_them:  # each, even if another one raises
            for process in self._processes.values():
                all_of_them.callback(process.end)

    # -- a control step ------------------------------------------------------------------------

    def _asking(self, robot: int) -> Callable[[RobotView], tuple[float, float]]:
        def control(view: RobotView) -> tuple[float, float]:
            world = cast("Simulation", view._world)
            if world.iteration != self._iteration or world is not self._world:
                self._ask_all(world)
            process = self._processes[self._drivers[robot]]
            command = process.command(world, robot)
            if process.fault is not None:
                self._judge(world.time)
            return command

        return control

    def _ask_all(self, world: Simulation) -> None:
        """Ask all laws for their commands of this control step; they think side by side."""
        if self._ears is None:
            raise InputError("the laws' processes do not run: use the Guard in a with statement")
        if self._world is None:
            self._world = world
        if world is not self._world or world.iteration <= self._iteration:
            raise InputError("a Guard is for one run: make another one for each world")
        self._iteration = world.iteration
        for process in self._processes.values():
            if process.fault is None:
                process.tell(process.look(world))  # it thinks while the next one is told
        self._wait()
        if any(process.fault for process in self._processes.values()):
            self._judge(world.time)

    def _wait(self) -> None:
        """Wait until all who were asked have answered, or their time is over."""
        assert self._ears is not None
        while asked := [process for process in self._processes.values() if process.asked]:
            wait = min(process.deadline for process in asked) - time.perf_counter()
            heard = self._ears.listen(max(0.0, wait))
            now = time.perf_counter() - (PATIENCE if heard else 0.0)
            for process in asked:
                if process.asked and process.deadline <= now:
                    process.expire()

    def _judge(self, time: float) -> None:
        """Raise what is said of the laws that have failed."""
        for role, process in self._processes.items():
            if process.fault is not None:
                self.verdicts[role] = Verdict(*process.fault, time)
        told = [f"{role}: {verdict.text}" for role, verdict in self.verdicts.items()]
        raise LawError("; ".join(told))


def _drivers(scenario: Scenario, laws: Mapping[str, tuple[Path, Sequence[int]]]) -> dict[int, str]:
    """Return the role whose law drives each robot. Raises InputError for two, or no such robot."""
    drivers: dict[int, str] = {}
    for role, (_, robots) in laws.items():
        for robot in robots:
            index = scenario.index_of(f"Guard.laws[{role!r}]", robot)
            if index in drivers:
                name = scenario.robots[index].name
                raise InputError(f"Guard.laws: {name} has the laws of {drivers[index]} and {role}")
            drivers[index] = role
    return drivers
