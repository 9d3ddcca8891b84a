"""Films, as several verbs make them: their arguments, speed and progress bar."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError
from mars2d.core.progress import Progress
from mars2d.output.films import film
from mars2d.output.films.footage import Cut
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.world.record import Record

if TYPE_CHECKING:
    from mars2d.output.films.footage import Footage

Film = Callable[[], object]
"""A function that makes a film, or another file."""

FPS = 25
"""Frames per second."""

SIZE = (1280, 720)
"""The default size of a film, pixels."""

DURATION = 12.0
"""The duration of a film for which no speed was given, seconds."""


def add_film(parser: argparse.ArgumentParser) -> None:
    """Add the film with its size, start and end."""
    add = parser.add_argument
    add("--video", type=Path, metavar="OUT", help="make a film: .gif, .mp4")
    add("--size", type=_size, metavar="WxH", help="of the film, pixels (default: 1280x720)")
    add("--from", type=float, dest="start", metavar="S", help="start the film at this time")
    add("--to", type=float, dest="end", metavar="S", help="end the film at this time")


def _size(text: str) -> tuple[int, int]:
    try:
        return film.size_of(text)
    except InputError as error:
        expected = "expected width and height in pixels, such as 1280x720"
        raise argparse.ArgumentTypeError(f"{text!r}: {expected}") from error


def check_film(arguments: argparse.Namespace, scenario: Scenario, last: float) -> None:
    """Check the options of a film of a run that lasts `last` seconds. Raises InputError."""
    options = {"--size": arguments.size, "--from": arguments.start, "--to": arguments.end}
    if arguments.video is None:
        for name, value in options.items():
            if value is not None:
                raise InputError(f"{name} needs --video OUT: it is of the film")
        return
    film.check_film(arguments.video, arguments.size or SIZE, FPS)
    speed = film_speed(scenario, arguments.speed)
    Cut.of(last, speed, FPS, arguments.start, arguments.end, "the run")


def film_speed(scenario: Scenario, speed: float | str | None) -> float:
    """Return a film's speed: as given, else the animation's, else that of a film of `DURATION`."""
    for choice in (speed, scenario.animation.playback_speed):
        if isinstance(choice, float) and choice > 0:
            return choice
    return max(scenario.stop_time / DURATION, 1e-9)


def save_footage(
    footage: Footage, last: Frame, path: Path, size: tuple[int, int] | None = None
) -> None:
    """Make a film from the footage of a run, with a progress bar."""

    def make(update: Callable[[int], None]) -> None:
        film.save_film(
            footage.frames(last),
            path,
            fps=FPS,
            size=size or SIZE,
            status=f"{footage.speed:.3g}x",
            progress=update,
        )

    _with_progress(footage.count(last), make)


def save_film_of(record: Record, arguments: argparse.Namespace) -> Path:
    """Make the requested film of a record, with a progress bar, and return its path."""
    path: Path = arguments.video
    speed = film_speed(record.scenario, arguments.speed)
    start, end = arguments.start, arguments.end

    def make(update: Callable[[int], None]) -> None:
        film.film_record(
            record,
            path,
            speed=speed,
            fps=FPS,
            size=arguments.size or SIZE,
            start=start,
            end=end,
            progress=update,
        )

    _with_progress(film.cut_of(record, speed, FPS, start, end).count, make)
    return path


def _with_progress(frames: int, make: Callable[[Callable[[int], None]], None]) -> None:
    progress = Progress(frames, "frames")
    try:
        make(progress.update)
    finally:
        progress.close()
