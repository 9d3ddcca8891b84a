"""Many worlds of one experiment in one process, as a vector environment of gymnasium."""

from __future__ import annotations

from functools import partial
from typing import Any, Unpack

from mars2d.core.description import wrong
from mars2d.core.extras import extra
from mars2d.rl.environment import Environment, Row
from mars2d.rl.episode import Source
from mars2d.rl.screen import Given
from mars2d.world.abreast import Abreast

with extra("rl", "environments need gymnasium"):
    from gymnasium.vector import AutoresetMode, SyncVectorEnv


class VectorEnvironment(SyncVectorEnv):
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
    a window shows the first world.

    envs: the environment of each world.
    """

    envs: list[_Member]

    def __init__(
        self,
        experiment: Source,
        robot: str | int = 0,
        num_envs: int = 1,
        *,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        **given: Unpack[Given],
    ) -> None:
        if num_envs < 1:
            raise wrong("num_envs", num_envs, "a number of worlds, at least 1")
        first = other = partial(_Member, experiment, robot, **given)
        if given.get("render_mode") == "human":
            other = partial(first, render_mode=None)
        super().__init__([first, *[other] * (num_envs - 1)], autoreset_mode=autoreset_mode)
        self._abreast = Abreast()

    def step(self, actions: Any) -> Any:
        """Do one control step in each world.

        actions: (n, m), as of `Environment.step`. Returns observations (n, k), rewards (n,),
        terminations (n,), truncations (n,), and infos: arrays (n,) whose mask has an underscore
        before its name. Raises InputError as `Environment.step` does.
        """
        if len(actions) != self.num_envs:
            raise wrong("step(actions)", actions, f"one for each of {self.num_envs} worlds")
        rests = self._autoreset_envs & (self.autoreset_mode is AutoresetMode.NEXT_STEP)
        commands = [
            None if rest else one.wanted(action)
            for one, action, rest in zip(self.envs, actions, rests, strict=True)
        ]
        self._abreast.step([one.world for one in self.envs], commands)
        return super().step(actions)


class _Member(Environment):
    """One of many: its world has done its step before `step` is called."""

    def step(self, action: Any) -> tuple[Row, float, bool, bool, dict[str, Any]]:  # noqa: ARG002
        """Return what has come of the step."""
        self._episode.settle()
        return self._results()
