"""Encoding of films, in a thread of its own, so that meanwhile the next pictures are drawn."""

from __future__ import annotations

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from io import RawIOBase
from typing import TYPE_CHECKING, BinaryIO, Self

from mars2d.output.films.gif import Gif
from mars2d.output.films.mp4 import Mp4

if TYPE_CHECKING:
    import pygame

MAX_WAITING = 4
"""How many pictures may wait to be encoded."""

ENCODERS: dict[str, type[Gif | Mp4]] = {".gif": Gif, ".mp4": Mp4}
"""By the endings of films."""


class Encoding:
    """A film that is being encoded; at the end of the `with` block it is complete.

    file: open for writing. suffix: .gif or .mp4. fps: frames per second. All
    methods raise what encoding raises, such as OSError for a full disk.
    """

    def __init__(self, file: BinaryIO | RawIOBase, suffix: str, fps: float) -> None:
        """Begin."""
        self._encoder = ENCODERS[suffix](file, fps)
        self._pool = ThreadPoolExecutor(1, "film")
        self._waiting: deque[Future[None]] = deque()
        self._sound = True  # unless encoding has failed

    @property
    def busy(self) -> bool:
        """Whether the next picture would have to wait."""
        while self._waiting and self._waiting[0].done():
            self._waiting.popleft().result()
        return len(self._waiting) >= MAX_WAITING

    def add(self, picture: pygame.Surface, times: int = 1) -> None:
        """Add a picture for some frames; afterwards it may be painted over."""
        if self.busy:
            self._waiting.popleft().result()
        self._waiting.append(self._pool.submit(self._encode, picture.copy(), times))

    def _encode(self, picture: pygame.Surface, times: int) -> None:
        """Do nothing after a failure: FFmpeg ends the process if it is to go on then."""
        if self._sound:
            self._sound = False
            for _ in range(times):
                self._encoder.add(picture)
            self._sound = True

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self._pool.shutdown()
        if kind is not None:
            with suppress(Exception):  # what failed fails again
                self._encoder.close()
            return
        try:
            for each in self._waiting:
                each.result()
        except BaseException as error:
            self.__exit__(type(error))
            raise
        self._encoder.close()
