"""Many worlds of one experiment in one process, as a vector environment of gymnasium."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import InputError
from mars2d.core.extras import extra
from mars2d.rl.environment import action_space, observation_space
from mars2d.rl.episode import Episode, Law, Reward, Source
from mars2d.rl.screen import MODES, Screen
from mars2d.world.abreast import Abreast
from mars2d.world.world import World

with extra("rl", "environments need gymnasium"):
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space

Rows = NDArray[np.float32]
Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


class VectorEnvironment(VectorEnv[Rows, Rows, NDArray[Any]]):
    """Many worlds of one experiment, in each of which the same robot learns.

    >>> environment = VectorEnvironment("corner_game", "pursuer", num_envs=3)
    >>> observations, infos = environment.reset(seed=1)
    >>> observations.shape
    (3, 6)

    num_envs: the number of worlds. World k is that of an `Environment` alone whose `reset` has had
    the seed seed + k, to the bit. autoreset_mode: when a world whose episode has ended starts
    again: in the next step, which then does no other thing, in the same step, which gives the last
    observation in ``infos["final_obs"]``, or when `reset` is called with
    ``options={"reset_mask": ended}``. The other arguments are those of `Environment`. For "human",
    the window shows the first world.
    """

    def __init__(
        self,
        experiment: Source,
        robot: str | int = 0,
        num_envs: int = 1,
        *,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        reward: Reward | None = None,
        laws: Mapping[str, Law] | None = None,
        options: Mapping[str, Any] | None = None,
        render_mode: str | None = None,
        size: tuple[int, int] = (640, 480),
        record: bool = False,
    ) -> None:
        self._screen = Screen(render_mode, size)
        self.render_mode = render_mode
        if not num_envs >= 1:
            raise wrong("num_envs", num_envs, "a number of worlds, at least 1")
        self.num_envs = num_envs
        self._mode = AutoresetMode(autoreset_mode)
        self._episodes = [
            Episode(experiment, robot, laws, reward, options, record) for _ in range(num_envs)
        ]
        first = self._episodes[0]
        self._learner = first.learners[0]
        self.metadata = {
            "render_modes": MODES, "render_fps": 1 / first.scenario.sampling_time,
            "autoreset_mode": self._mode,
        }  # fmt: skip
        self.single_observation_space = observation_space(first, 0)
        self.single_action_space = action_space(first, 0)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._observations = np.zeros(self.observation_space.shape, np.float32)
        self._ended = np.zeros(num_envs, dtype=bool)
        self._abreast = Abreast()

    @property
    def worlds(self) -> tuple[World, ...]:
        """The live worlds."""
        return tuple(episode.world for episode in self._episodes)

    @property
    def policy_metadata(self) -> str:
        """The text that a policy's ONNX file needs as its metadata ``mars2d``: the spaces."""
        return self._episodes[0].metadata_of(0)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Rows, dict[str, Any]]:
        """Begin an episode in each world; return the first observations (n, k), and an empty dict.

        seed: world k gets seed + k, or number k of a list; None: see `Environment.reset`. options:
        a mask ``reset_mask`` (n,) says which worlds begin again; the others go on.
        """
        seeds = [seed] * self.num_envs if seed is None else seed
        if isinstance(seeds, (int, np.integer)):
            seeds = [int(seeds) + k for k in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise wrong("seed", seed, f"a number, or one for each of {self.num_envs} worlds")
        mask = np.ones(self.num_envs, dtype=bool)
        if options and "reset_mask" in options:
            mask = np.asarray(options["reset_mask"], dtype=bool)
            if mask.shape != (self.num_envs,):
                raise wrong("reset_mask", mask, f"a truth value for each of {self.num_envs} worlds")
        for k in np.flatnonzero(mask).tolist():
            self._start(k, seeds[k])
        self._screen.follow(self._episodes[0].world)
        return self._observations.copy(), {}

    def _start(self, k: int, seed: int | None = None) -> None:
        """Begin an episode in world k."""
        self._episodes[k].start(seed)
        self._ended[k] = False
        self._observations[k] = self._episodes[k].observed(0)

    def step(self, actions: Any) -> tuple[Rows, Floats, Flags, Flags, dict[str, Any]]:
        """Do one control step in each world.

        actions: (n, m), as of `Environment.step`. Returns observations (n, k), rewards (n,),
        terminations (n,), truncations (n,), and infos: arrays (n,) whose mask has an underscore
        before its name. Raises InputError as `Environment.step` does.
        """
        if len(actions) != self.num_envs:
            raise InputError(
                f"step(actions): {len(actions)} actions, expected one for each of "
                f"{self.num_envs} worlds"
            )
        rests = self._ended & (self._mode is AutoresetMode.NEXT_STEP)
        commands: list[dict[int, tuple[float, ...]] | None] = [None] * self.num_envs
        going = [(k, self._episodes[k]) for k in np.flatnonzero(~rests).tolist()]
        for k, episode in going:
            episode.check_going()
            commands[k] = {self._learner: episode.command(0, actions[k])}
        self._abreast.step(self.worlds, commands)
        for k in np.flatnonzero(rests).tolist():
            self._start(k)
        rewards = np.zeros(self.num_envs)
        terminated, truncated = np.zeros((2, self.num_envs), dtype=bool)
        infos: dict[str, Any] = {}
        for k, episode in going:
            episode.settle()
            rewards[k] = episode.reward(0)
            terminated[k], truncated[k] = ended = episode.ended(0)
            self._observations[k] = episode.observed(0)
            if any(ended):
                self._end(k, infos)
        self._screen.follow(self._episodes[0].world)
        return self._observations.copy(), rewards, terminated, truncated, infos

    def _end(self, k: int, infos: dict[str, Any]) -> None:
        """Note the end of world k's episode, and begin another if it is time to."""
        over = self._episodes[k].over
        self._ended[k] = True
        if self._mode is AutoresetMode.SAME_STEP:
            over = {"final_obs": self._observations[k].copy(), "final_info": over}
            self._start(k)
        infos.update(self._add_info(infos, over, k))

    def render(self) -> Any:
        """Return a picture (height, width, 3) of each world; for "human" show the first one."""
        if self._screen.mode == "human":
            return self._screen.render(self._episodes[0].world)
        return tuple(self._screen.render(episode.world) for episode in self._episodes)

    def close_extras(self, **_: Any) -> None:
        """Close the window."""
        self._screen.close()
