"""Films of frames, as an animated GIF or an MP4, without a display."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.output.figures.extent import check_rows
from mars2d.output.films.footage import Cut, shots
from mars2d.output.films.gif import Gif
from mars2d.output.films.mp4 import Mp4, require_av
from mars2d.output.raster import require_pygame
from mars2d.record.frame import Frame

if TYPE_CHECKING:
    import pygame

    from mars2d.record.rows import Rows

ENCODERS: dict[str, type[Gif | Mp4]] = {".gif": Gif, ".mp4": Mp4}
"""By the endings of films."""

MIN_SIZE, MAX_SIZE = (64, 64), (3840, 2160)
"""The limits of a film's size, pixels."""

MIN_FPS = 0.1
MAX_FPS = {".gif": 50, ".mp4": 240}
"""The limits of frames per second; no program shows more in a GIF."""


def film_record(
    record: Rows,
    path: str | os.PathLike[str],
    *,
    speed: float = 1.0,
    size: tuple[int, int] = (1280, 720),
    fps: float = 25,
    start: float | None = None,
    end: float | None = None,
    sensors: bool = True,
) -> Path:
    """Make a film of a record, .gif or .mp4, and return its path.

    speed: simulated seconds per second of the film; frames between sampling times are interpolated.
    size: pixels, 64 x 64 to 3840 x 2160, for .mp4 both even. fps: frames per second, at most 50 in
    a GIF. start, end: seconds, the part of the run that is shown, by default all. sensors: whether
    they are drawn. The file appears under its name when it is complete.

    Raises InputError for arguments that make no film and where it can't be written,
    MissingExtraError for .mp4 without PyAV, and without pygame.
    """
    check_film(path, size, fps)

    cut = cut_of(record, speed, fps, start, end)
    frames = shots(cut, record.scenario.sampling_time, len(record) - 1, record.frame)
    save_film(frames, path, fps=fps, size=size, sensors=sensors, status=f"{speed:.3g}x")
    return Path(path)


def cut_of(
    record: Rows,
    speed: float = 1.0,
    fps: float = 25,
    start: float | None = None,
    end: float | None = None,
) -> Cut:
    """Return the part of a record that a film shows; see `film_record`."""
    check_rows(record, "film")
    return Cut.of(float(record.time[-1]), speed, fps, start, end, "the record")


def check_film(
    path: str | os.PathLike[str], size: tuple[int, int] | None = None, fps: float = 25
) -> None:
    """Refuse a film that can't be made, before anything is run or drawn for it.

    size: None if it is that of pictures. Raises InputError and MissingExtraError as `film_record`.
    """
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix not in ENCODERS:
        raise InputError(f"{target}: expected a film's name to end in {' or '.join(ENCODERS)}")
    if not MIN_FPS <= real("fps", fps, "a number > 0") <= MAX_FPS[suffix]:
        raise wrong("fps", fps, f"{MIN_FPS} to {MAX_FPS[suffix]} frames per second in a {suffix}")
    if suffix == ".mp4":
        require_av(target)
    require_pygame("a film")
    if size is None:
        return
    expected = "(width, height) in pixels, {} x {} to {} x {}".format(*MIN_SIZE, *MAX_SIZE)
    if not (
        isinstance(size, (tuple, list))
        and len(size) == 2
        and all(isinstance(side, int) and not isinstance(side, bool) for side in size)
        and all(a <= b <= c for a, b, c in zip(MIN_SIZE, size, MAX_SIZE, strict=True))
    ):
        raise wrong("size", size, expected)
    width, height = size
    if suffix == ".mp4" and (width % 2 or height % 2):
        even = f"{width + width % 2} x {height + height % 2}"
        raise wrong("size", size, f"even numbers of pixels for .mp4, such as {even}")


def size_of(text: str) -> tuple[int, int]:
    """Return the size in a text such as "1280x720"; `check_film` checks it."""
    width, cross, height = text.strip().lower().partition("x")
    if not (cross and width.strip().isdecimal() and height.strip().isdecimal()):
        raise InputError(f"size = {text!r}: expected width and height in pixels, such as 1280x720")
    return int(width), int(height)


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

    fps: frames per second, at most 50 in a GIF. size: pixels, even for .mp4. status: the text
    beside the time, for example "10x". progress: called with the number of frames written so far.
    The file appears under its name when it is complete.

    Raises InputError for another suffix or where it can't be written, MissingExtraError for .mp4
    without PyAV.
    """
    import pygame

    from mars2d.output.raster.picture import Artist

    artist, surface = Artist(size, sensors=sensors, status=status), pygame.Surface(size, 0, 32)
    save_pictures((artist.paint(frame, surface) for frame in frames), path, fps, progress)


def save_pictures(
    pictures: Iterable[pygame.Surface],
    path: str | os.PathLike[str],
    fps: float = 25,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Write pictures, all of one size, as .gif or .mp4; for .mp4 both sides must be even.

    All may be drawn on one surface. Raises InputError and MissingExtraError as `save_film`.
    """
    check_film(path, fps=fps)
    target, count = Path(path), 0
    with atomic_write(target) as file:
        encoder = ENCODERS[target.suffix.lower()](Path(file.name), fps)
        try:
            for count, picture in enumerate(pictures, 1):
                encoder.add(picture)
                if progress is not None:
                    progress(count)
        finally:
            encoder.close()
        if count == 0:
            raise InputError(f"{target}: a film needs at least one frame")
