"""An episode: a world in which some robots learn, and laws drive the others."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import isfinite, nan
from pathlib import Path
from types import ModuleType
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, shown
from mars2d.scenario.experiment import load_law, open_experiment
from mars2d.scenario.observation import Action, Observation
from mars2d.scenario.policy import describe
from mars2d.scenario.roles import contests_of, robots_named, role_of, roles_of
from mars2d.scenario.scenario import Scenario
from mars2d.world.loop import open_world
from mars2d.world.record import Record
from mars2d.world.room import Room
from mars2d.world.views import RobotView
from mars2d.world.world import World

Source = str | Path | ModuleType | Scenario
Law = Callable[[Any], Any] | str | Path
Reward = Callable[[World, RobotView], float]
"""Called with the world and a learner after each step; returns the reward of that step."""


SEEDS = 2**31
"""Episodes without a seed of their own draw one below this."""


class Episode:
    """A world that starts again with each `start`, and the robots in it that learn.

    learners: their indices. observations, actions: what each
    of them sees and does. world: the live one.
    """

    def __init__(
        self,
        source: Source,
        learners: str | int | Sequence[str | int] | None,
        laws: Mapping[str, Law] | None,
        reward: Reward | None,
        options: Mapping[str, Any] | None,
        record: bool,
    ) -> None:
        """Take an experiment and the learners: names, indices or roles; None: all robots.

        Raises InputError for an experiment that can't be opened, and a robot or role that is not
        there.
        """
        self._source, self._options = source, dict(options or {})
        opened = open_experiment(source, self._options)
        self.experiment = str(source) if isinstance(source, (str, Path)) else ""
        function = opened.source.function
        takes = () if function is None else inspect.signature(function).parameters
        self._draws = "seed" in takes and "seed" not in self._options
        self._random = np.random.default_rng()
        scenario = opened.scenario
        self.learners = (
            tuple(range(len(scenario.robots)))
            if learners is None
            else _indices(scenario, learners, "learner =")
        )
        self._laws = _laws_of(scenario, laws or {}, self.learners)
        if reward is None and not contests_of(scenario):
            raise InputError(
                "reward = None: expected a function reward(world, robot), as the experiment has no "
                "contest whose winner gets 1 and whose loser gets -1"
            )
        self._reward = won_or_lost if reward is None else reward
        self.world = open_world(replace(opened, scenario=self._cast(scenario)), record=record)
        self.world.observe()
        self.observations = [
            Observation.of(scenario, i, self.world.robots[i]) for i in self.learners
        ]
        self.names = [str(scenario.robots[i].name) for i in self.learners]
        self.actions = [
            Action.of(scenario.robots[i].drive, name)
            for i, name in zip(self.learners, self.names, strict=True)
        ]

    @property
    def scenario(self) -> Scenario:
        """The scenario of the present world."""
        return self.world.scenario

    @property
    def record(self) -> Record:
        """The record so far. Raises InputError where none is kept."""
        if not self.world.recorder.keeps:
            raise InputError("no record is kept: make the environment with record=True")
        return self.world.record

    def metadata_of(self, k: int) -> str:
        """Return the metadata of a policy's file for learner k: its spaces and its experiment."""
        drive = self.scenario.robots[self.learners[k]].drive
        return describe(
            self.observations[k], self.actions[k], type(drive).__name__, self.experiment,
            self.names[k],
        )  # fmt: skip

    def _cast(self, scenario: Scenario) -> Scenario:
        """Return a scenario in which learners have no laws, and others those that were given."""
        robots = [
            robot.replace(controller=None)
            if i in self.learners
            else robot.replace(controller=self._laws.get(i, robot.controller))
            for i, robot in enumerate(scenario.robots)
        ]
        return scenario.replace(robots=robots)

    def start(self, seed: int | None) -> None:
        """Start again: all random numbers, also those of starts, are drawn from the seed.

        None: a new one, from the generator that was seeded last.
        """
        if seed is None:
            seed = int(self._random.integers(SEEDS))
        else:
            self._random = np.random.default_rng(seed)
        scenario = None
        if self._draws:
            scenario = self._cast(open_experiment(self._source, self._options, seed=seed).scenario)
        self.world.reset(seed=seed, scenario=scenario)
        self._room: Room | None = None
        now = self.world.scenario
        if now.workspace is not None and now.on_exit == "stop":
            self._room = Room(now.workspace, len(now.robots))
        self.world.observe()

    def step(self, commands: Mapping[int, tuple[float, ...]]) -> None:
        """Do one control step, and let add-ons and sensors see the instant after it."""
        every = len(commands) == len(self.world.robots)
        alike = every and len({*map(len, commands.values())}) == 1
        self.world.step(
            np.array([commands[i] for i in range(len(commands))]).T if alike else commands
        )
        self.settle()

    def settle(self) -> None:
        """Let add-ons and sensors see the instant after a step, and end the episode if need be."""
        world = self.world
        world.observe()
        held = world.operator.held
        if held and not world.over and all(robot in held for robot in self.learners):
            world.stop(f"{', '.join(self.names)}: out of the game after {world.time:g} s")
        gone = self._room is not None and self._room.left(world.pose[:2])
        if not world.over and (gone or self.time_is_over):
            world.step({})  # the last row of the record, in which nothing moves any more

    @property
    def time_is_over(self) -> bool:
        """Whether the stop time is reached."""
        return self.world.iteration >= self.world.scenario.last_iteration

    def ended(self, k: int) -> tuple[bool, bool]:
        """Return whether learner k has come to an end before its time, and whether time is over."""
        if not self.world.over:
            return self.learners[k] in self.world.operator.held, False
        return not self.time_is_over, self.time_is_over

    @property
    def over(self) -> dict[str, Any]:
        """Why it is over, as ``over``; empty before."""
        return {"over": self.world.over_message} if self.world.over else {}

    def observed(self, k: int) -> NDArray[np.float32]:
        """Return learner k's observation."""
        return self.observations[k](self.world.robots[self.learners[k]])

    def reward(self, k: int) -> float:
        """Return learner k's reward for the last step."""
        value = self._reward(self.world, self.world.robots[self.learners[k]])
        try:
            worth = float(value)
        except (TypeError, ValueError):
            worth = nan
        if not isfinite(worth):
            raise InputError(f"reward returned {shown(value)}: expected a finite number")
        return worth

    def command(self, k: int, action: Any) -> tuple[float, ...]:
        """Return learner k's command: an action of -1 is the drive's least one, 1 the largest.

        Actions beyond are clipped. Raises InputError unless it is a finite number for each input,
        and when the episode is over.
        """
        if self.world.over:
            raise InputError(
                f"the episode is over: {self.world.over_message}; reset() begins another"
            )
        try:
            values = np.asarray(action, dtype=float)
        except (TypeError, ValueError):
            values = np.empty(0)
        shape = (len(self.actions[k].low),)
        if values.shape != shape:
            found = f"an array of shape {values.shape}" if values.size else shown(action)
            self._refuse(k, found, f"shape {shape}")
        shares = values.tolist()
        if not isfinite(sum(map(abs, shares))):
            self._refuse(k, shown(tuple(shares)), "all finite")
        return self.actions[k](shares)

    def _refuse(self, k: int, found: str, expected: str) -> NoReturn:
        inputs = self.scenario.robots[self.learners[k]].drive.inputs
        names = ", ".join(quantity.name for quantity in inputs)
        raise InputError(
            f"the action of {self.names[k]} is {found}: expected shares of its bounds for "
            f"({names}), from -1 to 1, {expected}"
        )


def won_or_lost(world: World, robot: RobotView) -> float:
    """Return 1 when a robot's role has won, -1 when another has; 0 before, and for a draw.

    A robot that is out of the contest before gets its own result.
    """
    if not (world.over or robot.index in world.operator.held):
        return 0.0
    mine = role_of(world.scenario, robot.index)
    for contest in contests_of(world.scenario):
        live = getattr(world.addons, contest.key)
        if live.winner is not None and mine:
            return 1.0 if live.winner == mine else -1.0
        if robot.index in live.results:
            return float(live.results[robot.index])
    return 0.0


def _indices(
    scenario: Scenario, named: str | int | Sequence[str | int], field: str
) -> tuple[int, ...]:
    """Return robots by names, indices or roles; a single name stands for one robot."""
    if isinstance(named, (str, int)):
        return robots_named(scenario, named, field)
    roles = roles_of(scenario)
    found = [
        robot
        for who in named
        for robot in (roles.get(str(who)) or robots_named(scenario, who, field))
    ]
    return tuple(dict.fromkeys(found))


def _laws_of(
    scenario: Scenario, laws: Mapping[str, Law], learners: Sequence[int]
) -> dict[int, Callable[[Any], Any]]:
    """Return the given laws by the indices of the robots that they drive."""
    found: dict[int, Callable[[Any], Any]] = {}
    for who, law in laws.items():
        robots = _indices(scenario, [who], "laws of")
        for robot in robots:
            if robot in learners:
                raise InputError(f"laws: {scenario.robots[robot].name} learns, it has no law")
            found[robot] = load_law(law) if isinstance(law, (str, Path)) else law
            if not callable(found[robot]):
                raise InputError(
                    f"laws[{who!r}] = {shown(law)}: expected a function of the robot, or a file"
                )
    return found
