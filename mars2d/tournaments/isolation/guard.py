"""Run a match whose laws can't spoil it: each role's law has its own process and limits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Self

from mars2d.core.errors import InputError, LawError
from mars2d.core.streams import check_seed
from mars2d.scenario.scenario import Scenario
from mars2d.tournaments.isolation.limits import Limits, Verdict
from mars2d.tournaments.isolation.observation import brief
from mars2d.tournaments.isolation.process import LawProcess
from mars2d.tournaments.isolation.source import law_code
from mars2d.world.simulation import Simulation
from mars2d.world.views import RobotView


class Guard:
    """Runs each law of a match in a process of its own, and gives a verdict on each that fails.

    Use it as a context manager, for one run. A law that fails raises a LawError from its robot's
    controller, which ends the run; all laws that fail in the same control step get verdicts.

    scenario: to be run by `World` or `simulate`; its robots ask the isolated laws. verdicts: of the
    laws that have failed, by role.
    """

    def __init__(
        self,
        scenario: Scenario,
        laws: Mapping[str, tuple[Path, Sequence[int]]],
        seed: int,
        limits: Limits = Limits(),  # noqa: B008 - it is frozen
        code: Mapping[str, Mapping[Path, bytes]] | None = None,
    ) -> None:
        """Take the scenario, each role's file and robot indices, and the run's seed.

        code: the contents of each role's files, see `law_code`; by default they are read now.
        Raises InputError for unknown robots, and for robots with two laws.
        """
        self._drivers = _drivers(scenario, laws)
        self._files = {role: Path(file).absolute() for role, (file, _) in laws.items()}
        self._robots = {role: robots for role, (_, robots) in laws.items()}
        self._code = code or {role: law_code(file) for role, file in self._files.items()}
        self._seed, self._limits = check_seed(seed), limits
        self._original = scenario
        robots = [
            robot.replace(controller=self._asking(i)) if i in self._drivers else robot
            for i, robot in enumerate(scenario.robots)
        ]
        self.scenario = scenario.replace(robots=robots)
        self.verdicts: dict[str, Verdict] = {}
        self._processes: dict[str, LawProcess] = {}
        self._running = ExitStack()
        self._world: Simulation | None = None
        self._iteration = -1

    @property
    def output(self) -> dict[str, str]:
        """The first 64 kB that each law has printed, by role; empty while it runs."""
        return {role: process.printed for role, process in self._processes.items()}

    def __enter__(self) -> Self:
        """Start the processes and load the laws."""
        if self._processes:
            raise InputError("a Guard is for one run: make another one")
        with ExitStack() as running:
            for role, robots in self._robots.items():
                briefing = brief(
                    self._original, role, self._files, self._code, robots, self._seed, self._limits
                )
                self._processes[role] = LawProcess(briefing)
                running.callback(self._processes[role].end)
                self._processes[role].load()
            self._running = running.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._running.close()

    def _asking(self, robot: int) -> Callable[[RobotView], tuple[float, float]]:
        def control(view: RobotView) -> tuple[float, float]:
            world = view._world
            if world.iteration != self._iteration or world is not self._world:
                self._ask_all(world)
            process = self._processes[self._drivers[robot]]
            command = process.command(world, robot)
            self._judge(world.time)
            return command

        return control

    def _ask_all(self, world: Simulation) -> None:
        """Ask one law after the other for its commands of this control step."""
        if not self._processes:
            raise InputError("the laws' processes do not run: use the Guard in a with statement")
        self._world = self._world or world
        if world is not self._world or world.iteration <= self._iteration:
            raise InputError("a Guard is for one run: make another one for each world")
        self._iteration = world.iteration
        for process in self._processes.values():
            if process.fault is None:
                process.ask(world)
        self._judge(world.time)

    def _judge(self, time: float) -> None:
        """Note the verdicts on laws that have failed, and raise them as a LawError."""
        for role, process in self._processes.items():
            if process.fault is not None:
                self.verdicts[role] = Verdict(*process.fault, time)
        if self.verdicts:
            told = [f"{role}: {verdict.text}" for role, verdict in self.verdicts.items()]
            raise LawError("; ".join(told))


def _drivers(scenario: Scenario, laws: Mapping[str, tuple[Path, Sequence[int]]]) -> dict[int, str]:
    """Return the role that drives each robot; InputError for two roles or an unknown robot."""
    drivers: dict[int, str] = {}
    for role, (_, robots) in laws.items():
        for robot in robots:
            index = scenario.index_of(f"Guard.laws[{role!r}]", robot)
            if index in drivers:
                name = scenario.robots[index].name
                raise InputError(f"Guard.laws: {name} has the laws of {drivers[index]} and {role}")
            drivers[index] = role
    return drivers
