"""How an environment is shown: as an array of pixels, or in a small window."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypedDict, Unpack

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import likely
from mars2d.output.raster import require_pygame
from mars2d.record.frame import Frame
from mars2d.rl.episode import Episode, Law, Reward, Source
from mars2d.world.record import Record
from mars2d.world.world import World

if TYPE_CHECKING:
    import pygame

MODES = ["human", "rgb_array"]


class Screen:
    """Shows the world of an environment, as the run window does, without its bars and buttons."""

    def __init__(self, mode: str | None, size: tuple[int, int]) -> None:
        """Take the render mode, and the size, pixels. Raises InputError for another mode."""
        if mode is not None and mode not in MODES:
            raise wrong("render_mode", mode, f"'human', 'rgb_array' or None{likely(mode, MODES)}")
        self.mode = mode
        self._window: pygame.Surface | None = None
        self._clock: pygame.time.Clock | None = None
        if mode is None:
            return
        require_pygame("a picture of an environment")
        import pygame

        from mars2d.output.raster.picture import Artist

        self._pygame, self._artist = pygame, Artist(size, sensors=True)

    def render(self, world: World) -> NDArray[np.uint8] | None:
        """Return the picture (height, width, 3) for "rgb_array"; show it for "human"."""
        if self.mode == "rgb_array":
            surface = self._artist.paint(world.frame)
            return np.ascontiguousarray(self._pygame.surfarray.array3d(surface).swapaxes(0, 1))
        self.follow(world)
        return None

    def follow(self, world: World) -> None:
        """Show a new instant, if there is a window."""
        if self.mode == "human":
            self._show(world.frame)

    def _show(self, frame: Frame) -> None:
        """Show a frame in the window, at the pace of real time."""
        pygame = self._pygame
        if self._window is None:
            pygame.display.init()
            self._window = pygame.display.set_mode(self._artist.size)
            pygame.display.set_caption(frame.scenario.title)
            self._clock = pygame.time.Clock()
        pygame.event.pump()
        self._window.blit(self._artist.paint(frame), (0, 0))
        pygame.display.flip()
        assert self._clock is not None
        self._clock.tick(1 / frame.scenario.sampling_time)

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._pygame.display.quit()
            self._window = None


class Given(TypedDict, total=False):
    """What all environments take besides the experiment and who learns, all of it optional.

    reward: called after each step with the world and the robot; by default 1 when the robot's role
    has won and -1 when it has lost; a robot that is out of a game before its end gets -1, and 1 if
    it is safe. It may end the episode by ``world.stop(why)``. laws: of others, by name or role, in
    place of their own: functions or files. options: of the experiment, as in `mars2d.run`.
    render_mode: "human" shows a window, "rgb_array" lets `render` return a picture. size: of both,
    pixels, by default (640, 480). record: whether to keep a record, which `record` then returns.
    """

    reward: Reward | None
    laws: Mapping[str, Law] | None
    options: Mapping[str, Any] | None
    render_mode: str | None
    size: tuple[int, int]
    record: bool


class Live:
    """What environments of one episode have in common: its world, its record and its picture."""

    def _begin(self, experiment: Source, learners: Any, **given: Unpack[Given]) -> Episode:
        self.render_mode = given.get("render_mode")
        self._screen = Screen(self.render_mode, given.get("size", (640, 480)))
        self._episode = Episode(
            experiment, learners, given.get("laws"), given.get("reward"), given.get("options"),
            given.get("record", False),
        )  # fmt: skip
        self.metadata = {
            "name": "mars2d", "render_modes": MODES, "is_parallelizable": True,
            "render_fps": 1 / self._episode.scenario.sampling_time,
        }  # fmt: skip
        return self._episode

    @property
    def world(self) -> World:
        """The live world."""
        return self._episode.world

    @property
    def record(self) -> Record:
        """The record of the present episode. Raises InputError where none is kept."""
        return self._episode.record

    def render(self) -> Any:
        """Return the picture (height, width, 3) for "rgb_array"; show it for "human"."""
        return self._screen.render(self.world)

    def close(self) -> None:
        """Close the window."""
        self._screen.close()
