"""Filming a screen while it is shown."""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError
from mars2d.core.files import writing
from mars2d.output.films.film import ENCODERS
from mars2d.output.films.mp4 import require_av

if TYPE_CHECKING:
    import pygame

FPS = 25

MAX_STILL = 2.0
"""For how many seconds a film stands still at most, while no picture comes."""


def film_suffix() -> str:
    """Return the suffix of films on this machine: .mp4 if PyAV is installed, else .gif."""
    return ".mp4" if importlib.util.find_spec("av") is not None else ".gif"


class Filming:
    """A film of pictures as they come, at FPS frames per second of the clock.

    Pass each picture that is shown to `take`, and call `stop` at the end. The film has the size of
    the first picture; others are scaled into it. If the program is killed, the film so far can be
    played.
    """

    def __init__(self, path: Path, clock: Callable[[], float] = time.perf_counter) -> None:
        """Begin a film, .mp4 or .gif. Raises InputError where it can't be written.

        clock: returns seconds. Raises MissingExtraError for .mp4 without PyAV.
        """
        if path.suffix == ".mp4":
            require_av(path)
        self.path, self.frames = path, 0
        self._clock, self._start = clock, clock()
        self._shown: pygame.Surface | None = None
        with writing(path):
            self._encoder = ENCODERS[path.suffix](path, FPS)

    @property
    def seconds(self) -> float:
        """The length of the film so far, seconds."""
        return self.frames / FPS

    def take(self, picture: pygame.Surface) -> None:
        """Take the picture that is shown now. Raises InputError if the film can't be written."""
        if self._shown is None:
            self._start = self._clock()
        due = int((self._clock() - self._start) * FPS) + 1 - self.frames
        if due < 1:
            return
        if due > MAX_STILL * FPS:
            self._start += due / FPS - MAX_STILL
            due = int(MAX_STILL * FPS)
        with writing(self.path):
            if self._shown is not None:
                for _ in range(due - 1):
                    self._encoder.add(self._shown)  # what was seen until then
            self._shown = _fitted(picture, self._shown)
            self._encoder.add(self._shown)
        self.frames += due

    def stop(self) -> Path:
        """End the film and return its path. Raises InputError if it could not be written."""
        with writing(self.path):
            self._encoder.close()
        if not self.frames:
            self.path.unlink(missing_ok=True)
            raise InputError(f"{self.path}: a film needs at least one picture")
        return self.path


def _fitted(picture: pygame.Surface, film: pygame.Surface | None) -> pygame.Surface:
    """Return a picture as a film's frame, whose sides are even; a larger or smaller one is scaled.

    film: a frame of its size; None for the first one, which has the size of the picture.
    """
    import pygame

    wide, high = picture.get_size()
    size = (wide + wide % 2, high + high % 2) if film is None else film.get_size()
    return pygame.transform.smoothscale(picture, size)
