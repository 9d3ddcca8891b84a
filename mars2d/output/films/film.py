"""Films of frames, as an animated GIF or an MP4, without a display."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.description import wrong
from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.output.films.footage import Cut, shots
from mars2d.output.films.gif import write_gif
from mars2d.output.films.mp4 import require_av, write_mp4
from mars2d.output.raster import require_pygame
from mars2d.record.frame import Frame

if TYPE_CHECKING:
    import pygame

    from mars2d.record.rows import Rows

SUFFIXES = (".gif", ".mp4")

MIN_SIZE, MAX_SIZE = (64, 64), (3840, 2160)
"""The limits of a film's size, pixels."""

MIN_FPS = 0.1
MAX_FPS = {".gif": 50, ".mp4": 240}
"""The limits of frames per second."""


def film_record(
    record: Rows,
    path: str | os.PathLike[str],
    *,
    speed: float = 1.0,
    size: tuple[int, int] = (1280, 720),
    fps: float = 25,
    start: float | None = None,
    end: float | None = None,
    progress: Callable[[int], None] | None = None,
) -> Path:
    """Make a film of a record, .gif or .mp4, and return its path.

    speed: simulated seconds per second of the film; frames between sampling times are interpolated.
    size: pixels, 64 x 64 to 3840 x 2160, for .mp4 both even. fps: frames per second, at most 50 in
    a GIF. start, end: seconds, the part of the run that is shown, by default all. progress: called
    with the number of frames written so far, of `cut_of(...).count`. The file appears under its
    name when it is complete.

    Raises InputError for arguments that make no film and where it can't be written,
    MissingExtraError for .mp4 without PyAV, and without pygame.
    """
    check_film(path, size, fps)

    cut = cut_of(record, speed, fps, start, end)
    frames = shots(cut, record.scenario.sampling_time, len(record) - 1, record.frame)
    save_film(frames, path, fps=fps, size=size, status=f"{speed:.3g}x", progress=progress)
    return Path(path)


def cut_of(
    record: Rows,
    speed: float = 1.0,
    fps: float = 25,
    start: float | None = None,
    end: float | None = None,
) -> Cut:
    """Return the part of a record that a film shows; see `film_record`."""
    if len(record) == 0:
        raise InputError("the record has no rows: there is nothing to be filmed")
    return Cut.of(float(record.time[-1]), speed, fps, start, end, "the record")


def check_film(path: str | os.PathLike[str], size: tuple[int, int], fps: float = 25) -> None:
    """Refuse a film that can't be made, before anything is run or drawn for it.

    Raises InputError and MissingExtraError as `film_record`.
    """
    suffix = _suffix(Path(path))
    _check_fps(fps, suffix)
    expected = "(width, height) in pixels, {} x {} to {} x {}".format(*MIN_SIZE, *MAX_SIZE)
    if not (
        isinstance(size, (tuple, list))
        and len(size) == 2
        and all(isinstance(side, int) and not isinstance(side, bool) for side in size)
        and all(a <= b <= c for a, b, c in zip(MIN_SIZE, size, MAX_SIZE, strict=True))
    ):
        raise wrong("size", size, expected)
    width, height = size
    if suffix == ".mp4":
        if width % 2 or height % 2:
            even = f"{width + width % 2} x {height + height % 2}"
            raise wrong("size", size, f"even numbers of pixels for .mp4, such as {even}")
        require_av(Path(path))
    require_pygame("a film")


def size_of(text: str) -> tuple[int, int]:
    """Return the size in a text such as "1280x720"; `check_film` checks it."""
    width, cross, height = text.strip().lower().partition("x")
    if not (cross and width.strip().isdecimal() and height.strip().isdecimal()):
        raise InputError(f"size = {text!r}: expected width and height in pixels, such as 1280x720")
    return int(width), int(height)


def film_rows(times: ArrayLike, speed: float = 1.0, fps: float = 25) -> NDArray[np.intp]:
    """Return the rows of a record that become the frames of a film, (f,).

    times: (T,) seconds, rising. speed: simulated seconds per second of the film, > 0. fps: frames
    per second. The film lasts (times[-1] - times[0]) / speed seconds, to the nearest frame; its
    first frame is the first row, its last frame the last. Each frame shows the newest row at its
    time.

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

    fps: frames per second, at most 50 in a GIF. size: pixels; made even for .mp4. status: the text
    beside the time, for example "10x". progress: called with the number of frames written so far.
    The file appears under its name when it is complete.

    Raises InputError for another suffix or where it can't be written, MissingExtraError for .mp4
    without PyAV.
    """
    if Path(path).suffix.lower() == ".mp4":
        size = (size[0] + size[0] % 2, size[1] + size[1] % 2)
    pictures = _pictures(frames, size, sensors=sensors, status=status, progress=progress)
    save_pictures(pictures, path, fps)


def save_pictures(
    pictures: Iterator[pygame.Surface], path: str | os.PathLike[str], fps: float = 25
) -> None:
    """Write pictures, all of one size, as .gif or .mp4; for .mp4 both sides must be even.

    Each picture is asked for when the one before is written, so all may be drawn on one surface.
    Raises InputError and MissingExtraError as `save_film`.
    """
    target = Path(path)
    suffix = _suffix(target)
    _check_fps(fps, suffix)
    if suffix == ".mp4":
        require_av(target)
    with atomic_write(target) as file:
        count = (write_gif if suffix == ".gif" else write_mp4)(file, pictures, fps)
        if count == 0:
            raise InputError(f"{target}: a film needs at least one frame")


def _suffix(target: Path) -> str:
    suffix = target.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"{target}: expected a film's name to end in {' or '.join(SUFFIXES)}")
    return suffix


def _check_fps(fps: float, suffix: str) -> None:
    _check_rate("fps", fps)
    if fps > MAX_FPS[suffix]:
        more = ", more a GIF can't show" if suffix == ".gif" else " in an MP4"
        raise InputError(f"fps = {fps:g}: expected at most {MAX_FPS[suffix]}{more}")
    if fps < MIN_FPS:
        raise InputError(f"fps = {fps:g}: expected at least {MIN_FPS}")


def _check_rate(name: str, value: object) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
        raise InputError(f"{name} = {value!r}: expected a number > 0")
    if not 0 < float(value) < float("inf"):
        raise InputError(f"{name} = {value!r}: expected a number > 0")


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

    from mars2d.output.raster.picture import Artist

    artist = Artist(size, sensors=sensors, status=status)
    surface = pygame.Surface(size, 0, 32)
    for count, frame in enumerate(frames, 1):
        yield artist.paint(frame, surface)
        if progress is not None:
            progress(count)
