"""An environment of PettingZoo: several robots of an experiment learn at the same time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError, nearest, shown
from mars2d.core.extras import extra
from mars2d.rl.environment import action_space, observation_space
from mars2d.rl.episode import Source
from mars2d.rl.screen import MODES, Given, Live

with extra("rl", "environments of several learners need pettingzoo"):
    from gymnasium.spaces import Box
    from pettingzoo import ParallelEnv

Row = NDArray[np.float32]


class ParallelEnvironment(Live, ParallelEnv[str, Row, Row]):
    """Several robots of an experiment learn at the same time, and laws drive the others.

    >>> environment = ParallelEnvironment("corner_game")
    >>> environment.possible_agents
    ['red', 'blue']

    robots: the learners: names, indices, or roles, of which all robots learn; None: all. Agents
    have the robots' names. One that is caught, shoved out or safe is terminated in that step and
    leaves `agents`, while the others go on. The other arguments, spaces and ends are those of
    `mars2d.rl.Environment`.
    """

    metadata: dict[str, Any] = {"name": "mars2d", "render_modes": MODES, "is_parallelizable": True}

    def __init__(
        self,
        experiment: Source,
        robots: Sequence[str | int] | None = None,
        **given: Unpack[Given],
    ) -> None:
        episode = self._begin(experiment, robots, **given)
        self.possible_agents = [*episode.names]
        self._places = {name: k for k, name in enumerate(episode.names)}
        self.agents: list[str] = []
        count = range(len(episode.names))
        self.observation_spaces = {episode.names[k]: observation_space(episode, k) for k in count}
        self.action_spaces = {episode.names[k]: action_space(episode, k) for k in count}

    def observation_space(self, agent: str) -> Box:
        """Return the space of an agent's observations; always the same object."""
        return self.observation_spaces[self.possible_agents[self._place(agent)]]

    def action_space(self, agent: str) -> Box:
        """Return the space of an agent's commands; always the same object."""
        return self.action_spaces[self.possible_agents[self._place(agent)]]

    def _place(self, agent: str) -> int:
        if agent not in self._places:
            hint = nearest(str(agent), self.possible_agents)
            raise InputError(f"ParallelEnvironment: there is no learner {shown(agent)}{hint}")
        return self._places[agent]

    def policy_metadata(self, agent: str) -> str:
        """Return the text that an ONNX file of this agent's policy needs as metadata ``mars2d``."""
        return self._episode.metadata_of(self._place(agent))

    def reset(
        self,
        seed: int | None = None,
        options: dict[str, Any] | None = None,  # noqa: ARG002
    ) -> tuple[dict[str, Row], dict[str, dict[str, Any]]]:
        """Begin an episode; return each agent's observation, and empty dicts."""
        self._episode.start(seed)
        self.agents = [*self.possible_agents]
        self._screen.follow(self.world)
        seen = {name: self._episode.observed(k) for k, name in enumerate(self.agents)}
        return seen, {agent: {} for agent in self.agents}

    def step(
        self, actions: Mapping[str, Any]
    ) -> tuple[
        dict[str, Row],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Do one control step under the action (m,) of each agent.

        Returns observations, rewards, terminations, truncations and infos, by agent. Raises
        InputError for an action that is missing, of another shape or not finite, and for an agent
        that is not there.
        """
        episode, agents = self._episode, self.agents
        acting = {self._place(agent): action for agent, action in actions.items()}
        here = {self._places[agent]: agent for agent in agents}
        for k in acting:
            if k not in here and not episode.world.over:
                raise InputError(f"step(actions): {episode.names[k]} is out of the game already")
        missing = [agent for k, agent in here.items() if k not in acting]
        if missing:
            raise InputError(f"step(actions): there is no action of {missing[0]}")
        episode.step({episode.learners[k]: episode.command(k, a) for k, a in acting.items()})
        rewards = {agent: episode.reward(k) for k, agent in here.items()}
        self._screen.follow(episode.world)
        ended = {agent: episode.ended(k) for k, agent in here.items()}
        self.agents = [agent for agent in agents if not any(ended[agent])]
        return (
            {agent: episode.observed(k) for k, agent in here.items()},
            rewards,
            {agent: terminated for agent, (terminated, _) in ended.items()},
            {agent: truncated for agent, (_, truncated) in ended.items()},
            {agent: dict(episode.over) for agent in agents},
        )
