"""Run a match whose laws can't spoil it: each role's law has its own process and limits."""

from __future__ import annotations

import contextlib
import os
import select
import socket
import time
from collections.abc import Callable, Mapping, Sequence
from math import ceil
from pathlib import Path
from typing import Self

from mars2d.core.errors import InputError, LawError
from mars2d.core.streams import check_seed
from mars2d.scenario.scenario import Scenario
from mars2d.study.isolation.limits import Limits, Verdict
from mars2d.study.isolation.observation import brief
from mars2d.study.isolation.process import LawProcess
from mars2d.world.simulation import Simulation
from mars2d.world.views import RobotView

LOOK = 0.1
"""The longest time between two looks at the memory of laws while they compute, seconds."""

CHATTER_TIME = 1.0
"""How long a law may go on sending after another law's time is over, seconds."""

SPIN_TIME = 3e-4
"""For how long the sockets are polled before the process sleeps, seconds. Most laws answer within
this time, and waking up takes as long. The processor is yielded to other processes meanwhile."""

_yield_processor = getattr(os, "sched_yield", lambda: None)


class Guard:
    """Runs each law of a match in a process of its own, and gives a verdict on each that fails.

    Use it as a context manager, for one run. A law that fails raises a LawError from its robot's
    controller, which ends the run; all laws that fail in the same control step get verdicts. It is
    not a sandbox: a law can still read and write files, for example.

    scenario: to be run by `World` or `simulate`; its robots ask the isolated laws. verdicts: of the
    laws that have failed, by role.
    """

    def __init__(
        self,
        scenario: Scenario,
        laws: Mapping[str, tuple[Path, Sequence[int]]],
        seed: int,
        limits: Limits = Limits(),  # noqa: B008 - it is frozen
    ) -> None:
        """Take the scenario, each role's file and robot indices, and the run's seed.

        Raises InputError for unknown robots, and for robots with two laws.
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
        self._poller: _Poller | None = None
        self._world: Simulation | None = None
        self._iteration = -1

    @property
    def output(self) -> dict[str, str]:
        """The first 64 kB that each law has printed, by role."""
        return {role: process.printed for role, process in self._processes.items()}

    def __enter__(self) -> Self:
        """Start the processes and load the laws, in parallel."""
        if self._processes:
            raise InputError("a Guard is for one run: make another one")
        briefings = brief(self._original, self._laws, self._seed, self._limits)
        count = len(self._original.robots), len(self._original.props)
        poller = self._poller = _Poller()
        try:
            for role, briefing in briefings.items():
                process = self._processes[role] = LawProcess(briefing, *count)
                poller.add(process.channel, process.receive)
                poller.add(process.output, process.drain)
            for process in self._processes.values():
                process.brief()
            self._wait()
        except BaseException:
            self._end()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def _end(self) -> None:
        """End all processes and everything that they have started."""
        self._poller = None
        with contextlib.ExitStack() as all_of_them:  # each, even if another one raises
            for process in self._processes.values():
                all_of_them.callback(process.end)

    # -- a control step ------------------------------------------------------------------------

    def _asking(self, robot: int) -> Callable[[RobotView], tuple[float, float]]:
        def control(view: RobotView) -> tuple[float, float]:
            world = view._world
            if world.iteration != self._iteration or world is not self._world:
                self._ask_all(world)
            process = self._processes[self._drivers[robot]]
            command = process.command(world, robot)
            if process.fault is not None:
                self._judge(world.time)
            return command

        return control

    def _ask_all(self, world: Simulation) -> None:
        """Ask all laws, in parallel, for their commands of this control step."""
        if self._poller is None:
            raise InputError("the laws' processes do not run: use the Guard in a with statement")
        if self._world is None:
            self._world = world
        if world is not self._world or world.iteration <= self._iteration:
            raise InputError("a Guard is for one run: make another one for each world")
        self._iteration = world.iteration
        for process in self._processes.values():
            if process.fault is None:
                process.tell(process.look(world))  # it computes while the next one is told
        self._wait()
        if any(process.fault for process in self._processes.values()):
            self._judge(world.time)

    def _wait(self) -> None:
        """Wait until each process that was asked has answered, or its time is over."""
        assert self._poller is not None
        while asked := [process for process in self._processes.values() if process.asked]:
            wait = min(process.deadline for process in asked) - time.perf_counter()
            heard = self._poller.wait(min(max(0.0, wait), LOOK))
            now = time.perf_counter() - (CHATTER_TIME if heard else 0.0)
            for process in asked:
                process.weigh()
                if process.asked and process.deadline <= now:
                    process.expire()

    def _judge(self, time: float) -> None:
        """Note the verdicts on laws that have failed, and raise them as a LawError."""
        for role, process in self._processes.items():
            if process.fault is not None:
                self.verdicts[role] = Verdict(*process.fault, time)
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


class _Poller:
    """Waits for sockets, and calls the function of each that can be read."""

    def __init__(self) -> None:
        self._readers: dict[int, Callable[[], object]] = {}
        self._poll = select.poll() if hasattr(select, "poll") else None  # not on Windows

    def add(self, source: socket.socket, read: Callable[[], object]) -> None:
        """Add a socket; `read` reads from it, and returns False after the end."""
        self._readers[source.fileno()] = read
        if self._poll is not None:
            self._poll.register(source, select.POLLIN)

    def wait(self, seconds: float) -> bool:
        """Wait until a socket can be read, and read all that can; return whether there was one."""
        if self._poll is not None:
            until = time.perf_counter() + min(seconds, SPIN_TIME)
            while not (events := self._poll.poll(0)) and time.perf_counter() < until:
                _yield_processor()
            events = events or self._poll.poll(ceil(1000 * seconds))
            ready = [descriptor for descriptor, _ in events]
        else:
            ready = select.select([*self._readers], [], [], seconds)[0]
        for descriptor in ready:
            if self._readers[descriptor]() is False:
                del self._readers[descriptor]
                if self._poll is not None:
                    self._poll.unregister(descriptor)
        return bool(ready)
