"""Films: frames as an animated GIF or an MP4, without a display."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.errors import InputError
from mars2d.frame import Frame
from mars2d.output.gif import write_gif
from mars2d.output.mp4 import require_av, write_mp4

if TYPE_CHECKING:
    import pygame

__all__ = ["SUFFIXES", "film_rows", "require_av", "save_film", "save_pictures"]

SUFFIXES = (".gif", ".mp4")


def film_rows(times: ArrayLike, speed: float = 1.0, fps: float = 25) -> NDArray[np.intp]:
    """Return which rows of a record become the frames of a film, (f,).

    times: (T,) seconds, rising. speed: simulated seconds a second of the film, > 0. fps: frames a
    second. The film lasts (times[-1] - times[0]) / speed seconds, to the nearest frame; its first
    frame is the first row, its last frame the last. Each frame shows the newest row at its time.

    >>> film_rows([0, 1, 2, 3, 4], speed=2, fps=2).tolist()
    [0, 1, 2, 4]
    """
    at = np.asarray(times, dtype=float)
    _check_rate("speed", speed)
    _check_rate("fps", fps)
    if at.ndim != 1 or len(at) == 0:
        raise InputError(f"times: expected at least one time, as (T,), not shape {at.shape}")
    count = max(1, round((at[-1] - at[0]) / speed * fps))
    if count == 1:
        return np.array([len(at) - 1])
    moments = np.linspace(at[0], at[-1], count)
    slack = 1e-9 * max(1.0, abs(at[-1]))
    rows: NDArray[np.intp] = np.searchsorted(at, moments + slack, side="right") - 1
    return rows


def save_film(
    frames: Iterable[Frame],
    path: str | os.PathLike[str],
    *,
    fps: float = 25,
    size: tuple[int, int] = (1280, 720),
    sensors: bool = True,
    status: str = "",
    progress: Callable[[int], None] | None = None,
) -> None:
    """Draw frames as the window draws them, and write them as .gif or .mp4.

    fps: frames a second, at most 50 in a GIF. size: pixels; for .mp4 made even. status: what stands
    beside the time, as "10x". progress: called with the number of frames written so far. The file
    appears under its name when it is complete.

    Raises InputError for another suffix or where it can't be written, MissingExtraError when .mp4
    is asked for and PyAV isn't installed.
    """
    if Path(path).suffix.lower() == ".mp4":
        size = (size[0] + size[0] % 2, size[1] + size[1] % 2)
    pictures = _pictures(frames, size, sensors=sensors, status=status, progress=progress)
    save_pictures(pictures, path, fps)


def save_pictures(
    pictures: Iterator[pygame.Surface], path: str | os.PathLike[str], fps: float = 25
) -> None:
    """Write pictures, all of one size, as .gif or .mp4; for .mp4 both sides must be even.

    Each is taken when the one before is written, so all may be drawn on the same surface. Raises
    InputError and MissingExtraError as `save_film`.
    """
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"{target}: expected a film's name to end in {' or '.join(SUFFIXES)}")
    _check_rate("fps", fps)
    if suffix == ".gif" and fps > 50:
        raise InputError(f"fps = {fps:g}: expected at most 50, more a GIF can't show")
    if suffix == ".mp4":
        require_av(target)
    with _replacing(target) as file:
        count = (write_gif if suffix == ".gif" else write_mp4)(file, pictures, fps)
        if count == 0:
            raise InputError(f"{target}: a film needs at least one frame")


def _check_rate(name: str, value: object) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
        raise InputError(f"{name} = {value!r}: expected a number > 0")
    if not 0 < float(value) < float("inf"):
        raise InputError(f"{name} = {value!r}: expected a number > 0")


@contextmanager
def _replacing(target: Path) -> Iterator[BinaryIO]:
    """Open a file beside `target` that takes its place once all has been written."""
    part = target.with_name(f".{target.name}.part")
    try:
        file = part.open("w+b")
    except OSError as error:
        raise InputError(f"{target}: can't be written, {error.strerror or error}") from None
    try:
        with file:
            yield file
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)


def _pictures(
    frames: Iterable[Frame],
    size: tuple[int, int],
    *,
    sensors: bool,
    status: str,
    progress: Callable[[int], None] | None,
) -> Iterator[pygame.Surface]:
    """Yield each frame's picture, always on the same surface."""
    import pygame

    from mars2d.view.picture import Artist

    artist = Artist(size, sensors=sensors, status=status)
    surface = pygame.Surface(size, 0, 32)
    for count, frame in enumerate(frames, 1):
        yield artist.paint(frame, surface)
        if progress is not None:
            progress(count)
