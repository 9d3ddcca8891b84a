"""Filming a screen while it is shown: a thread writes the film, and the screen goes on."""

from __future__ import annotations

import contextlib
import importlib.util
import queue
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, NamedTuple, cast

from mars2d.core.errors import InputError
from mars2d.core.files import growing
from mars2d.output.films.gif import write_gif
from mars2d.output.films.mp4 import require_av, rewrapped, write_mp4

if TYPE_CHECKING:
    import pygame

FPS = 25

MAX_WAITING = 4
"""How many pictures may wait to be written; while so many do, new ones are left out."""

MAX_STILL = 2.0
"""For how many seconds a film stands still at most, while no picture comes."""


def film_suffix() -> str:
    """Return the suffix of films on this machine: .mp4 if PyAV is installed, else .gif."""
    return ".mp4" if importlib.util.find_spec("av") is not None else ".gif"


class _Shot(NamedTuple):
    """A picture, and the number of frames from the picture before to it."""

    picture: pygame.Surface
    after: int


class Filming:
    """A film of pictures as they come, at FPS frames per second of the clock.

    Pass each picture that is shown to `take`, and call `stop` at the end. The film has the size of
    the first picture; others are scaled into it. If the program is killed, the film so far can be
    played. `take` only copies a picture when a frame is due.
    """

    def __init__(self, path: Path, clock: Callable[[], float] = time.perf_counter) -> None:
        """Begin a film, .mp4 or .gif. Raises InputError where it can't be written.

        clock: returns seconds. Raises MissingExtraError for .mp4 without PyAV.
        """
        if path.suffix == ".mp4":
            require_av(path)  # imports it as well, so that pictures need not wait
        self.path = path
        self.frames = 0
        self._clock = clock
        self._start: float | None = None
        self._shots: queue.Queue[_Shot | None] = queue.Queue(MAX_WAITING)
        self._problem: str | None = None
        without_buffer = growing(path, afresh=True).detach()  # so that nothing is lost
        self._file = cast("BinaryIO", without_buffer)
        self._thread = threading.Thread(target=self._write, name="filming", daemon=True)
        self._thread.start()

    @property
    def seconds(self) -> float:
        """The length of the film so far, seconds."""
        return self.frames / FPS

    def take(self, picture: pygame.Surface) -> None:
        """Take the picture that is shown now. Raises InputError if the film can't be written."""
        now = self._clock()
        if self._start is None:
            self._start = now
        due = int((now - self._start) * FPS) + 1 - self.frames
        self._check()
        if due < 1 or self._shots.full():
            return
        if due > MAX_STILL * FPS:
            self._start += due / FPS - MAX_STILL
            due = int(MAX_STILL * FPS)
        self._shots.put(_Shot(picture.copy(), due))
        self.frames += due

    def stop(self) -> Path:
        """End the film and return its path. Raises InputError if it could not be written."""
        while self._thread.is_alive():
            with contextlib.suppress(queue.Full):
                self._shots.put(None, timeout=0.1)
                break
        self._thread.join()
        self._file.close()
        self._check()
        if not self.frames:
            self.path.unlink(missing_ok=True)
            raise InputError(f"{self.path}: a film needs at least one picture")
        if self.path.suffix == ".mp4":
            rewrapped(self.path)
        return self.path

    def _check(self) -> None:
        if self._problem is not None:
            raise InputError(f"{self.path}: the film can't be written, {self._problem}")

    def _write(self) -> None:
        """Write pictures until there are no more; done by a thread."""
        try:
            if self.path.suffix == ".mp4":
                write_mp4(self._file, self._pictures(), FPS, in_pieces=True)
            else:
                write_gif(self._file, self._pictures(), FPS)
        except Exception as error:  # the libraries have their own each
            self._problem = getattr(error, "strerror", None) or str(error)

    def _pictures(self) -> Iterator[pygame.Surface]:
        """Yield the film's frames, all on the same surface."""
        import pygame

        film: pygame.Surface | None = None
        while (shot := self._shots.get()) is not None:
            if film is None:
                width, height = shot.picture.get_size()
                film = pygame.Surface((width + width % 2, height + height % 2), 0, 32)
            else:
                for _ in range(shot.after - 1):  # what was seen until then
                    yield film
            _fit(shot.picture, film)
            yield film


def _fit(picture: pygame.Surface, film: pygame.Surface) -> None:
    """Draw a picture in the middle of a film's frame, as large as fits."""
    import pygame

    width, height = film.get_size()
    across, down = picture.get_size()
    if max(abs(width - across), abs(height - down)) > 1:  # not only made even
        scale = min(width / across, height / down)
        size = max(round(scale * across), 1), max(round(scale * down), 1)
        picture = pygame.transform.smoothscale(picture, size)
    film.fill("black")
    film.blit(picture, picture.get_rect(center=film.get_rect().center))
