"""An environment of gymnasium: one robot of an experiment learns."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from mars2d.core.extras import extra
from mars2d.rl.episode import Episode, Source
from mars2d.rl.screen import MODES, Given, Live

with extra("rl", "environments need gymnasium"):
    import gymnasium
    from gymnasium.spaces import Box

Row = NDArray[np.float32]


def observation_space(episode: Episode, k: int) -> Box:
    """Return the space of learner k's observations."""
    seen = episode.observations[k]
    return Box(seen.low.astype(np.float32), seen.high.astype(np.float32), dtype=np.float32)


def action_space(episode: Episode, k: int) -> Box:
    """Return the space of learner k's actions: a share for each input of its drive."""
    return Box(-1.0, 1.0, (len(episode.actions[k].low),), np.float32)


class Environment(Live, gymnasium.Env[Row, Row]):
    """One robot of an experiment learns, and laws drive the others.

    >>> environment = Environment("corner_game", "pursuer")
    >>> observation, info = environment.reset(seed=1)
    >>> observation, reward, terminated, truncated, info = environment.step([1.0, 0.0])
    >>> environment.action_space
    Box(-1.0, 1.0, (2,), float32)

    experiment: a file, the name of an example, or a Scenario. robot: who learns: a name, an index,
    or a game's role, of which the first robot learns. given: see `mars2d.rl.screen.Given`.

    An observation is what the robot's law may see, see `mars2d.scenario.observation.Observation`;
    an action is a command in shares of the drive's bounds, `Drive.bounds`, from -1 to 1. An episode
    is terminated when something ends the experiment, such as a capture, or puts the robot out of a
    game that goes on. It is truncated at its stop time. The seed of `reset` is that of all random
    streams, and of the starts where the experiment draws them.

    Raises InputError for anything else.
    """

    metadata: dict[str, Any] = {"render_modes": MODES, "render_fps": 10}

    def __init__(
        self,
        experiment: Source,
        robot: str | int = 0,
        **given: Unpack[Given],
    ) -> None:
        episode = self._begin(experiment, robot, **given)
        self.observation_space = observation_space(episode, 0)
        self.action_space = action_space(episode, 0)
        self._learner = episode.learners[0]

    @property
    def policy_metadata(self) -> str:
        """The text that a policy's ONNX file needs as its metadata ``mars2d``: the spaces."""
        return self._episode.metadata_of(0)

    def reset(
        self,
        *,
        seed: int | None = None,
        options: dict[str, Any] | None = None,  # noqa: ARG002
    ) -> tuple[Row, dict[str, Any]]:
        """Begin an episode; return the first observation, and an empty dict.

        seed: of all that is random; None: a new one from the generator that was seeded last.
        """
        super().reset(seed=seed)
        self._episode.start(seed)
        self._screen.follow(self.world)
        return self._episode.observed(0), {}

    def step(self, action: Any) -> tuple[Row, float, bool, bool, dict[str, Any]]:
        """Do one control step; return observation, reward, terminated, truncated and info.

        action: shares of the drive's bounds (m,). info: ``over``, why the episode has ended, once
        it has. Raises InputError for an action of another shape or that is not finite, and after
        the end.
        """
        self._episode.step(self.wanted(action))
        return self._results()

    def wanted(self, action: Any) -> dict[int, tuple[float, ...]]:
        """Return the learner's command, by its index. Raises InputError as `step` does."""
        return {self._learner: self._episode.command(0, action)}

    def _results(self) -> tuple[Row, float, bool, bool, dict[str, Any]]:
        episode = self._episode
        reward = episode.reward(0)
        self._screen.follow(episode.world)
        return episode.observed(0), reward, *episode.ended(0), episode.over
