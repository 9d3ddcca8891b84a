"""Encoding of films, in a thread of its own, so that meanwhile the next picture is drawn."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import nullcontext, suppress
from io import RawIOBase
from typing import TYPE_CHECKING, BinaryIO, Self

from mars2d.output.films.gif import Gif
from mars2d.output.films.mp4 import Mp4

if TYPE_CHECKING:
    import pygame

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
        self._last: Future[None] | None = None

    @property
    def busy(self) -> bool:
        """Whether the next picture would have to wait."""
        return self._last is not None and not self._last.done()

    def add(self, picture: pygame.Surface, times: int = 1) -> None:
        """Add a picture for some frames; afterwards it may be painted over."""
        if self._last is not None:
            self._last.result()  # after a failure none is added: FFmpeg would end the process
        self._last = self._pool.submit(self._encode, picture.copy(), times)

    def _encode(self, picture: pygame.Surface, times: int) -> None:
        for _ in range(times):
            self._encoder.add(picture)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self._pool.shutdown()
        failed = kind or (self._last and self._last.exception())
        with suppress(Exception) if failed else nullcontext():  # what failed fails again
            self._encoder.close()
        if kind is None and self._last is not None:
            self._last.result()
