"""How an environment is shown: as an array of pixels, or in a small window."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import likely
from mars2d.output.raster import require_pygame
from mars2d.record.frame import Frame

if TYPE_CHECKING:
    import pygame

__all__ = ["MODES", "Screen", "checked_mode"]

MODES = ["human", "rgb_array"]


def checked_mode(mode: str | None) -> str | None:
    """Return a render mode. Raises InputError, with the nearest one, if there is none."""
    if mode is not None and mode not in MODES:
        raise wrong("render_mode", mode, f"'human', 'rgb_array' or None{likely(mode, MODES)}")
    return mode


class Screen:
    """Paints frames, as the run window does, without its bars and buttons."""

    def __init__(self, size: tuple[int, int], shown: bool) -> None:
        """Take the size, pixels; shown: whether to show the pictures in a window."""
        require_pygame("a picture of an environment")
        import pygame

        from mars2d.output.raster.picture import Artist

        self._artist = Artist(size, sensors=True)
        self._pygame, self._shown = pygame, shown
        self._window: pygame.Surface | None = None
        self._clock: pygame.time.Clock | None = None

    def pixels(self, frame: Frame) -> NDArray[np.uint8]:
        """Return the picture of a frame, (height, width, 3)."""
        surface = self._artist.paint(frame)
        return np.ascontiguousarray(self._pygame.surfarray.array3d(surface).swapaxes(0, 1))

    def show(self, frame: Frame) -> None:
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
        """Close the window."""
        if self._window is not None:
            self._pygame.display.quit()
            self._window = None
