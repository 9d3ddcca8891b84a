"""The output files of a run: those of --record, --figure, --video and --html."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from mars2d.cli.arguments import refuse
from mars2d.core.errors import InputError, Mars2dError, one_line
from mars2d.core.interrupt import interrupts
from mars2d.core.progress import progress
from mars2d.core.terminal import tell, warn
from mars2d.output import formats
from mars2d.output.figures import figure
from mars2d.output.films import film
from mars2d.output.films.footage import Cut, Drawings, shots
from mars2d.output.raster import require_pygame
from mars2d.record.rows import Rows
from mars2d.scenario.examples import experiment_name
from mars2d.scenario.scenario import Scenario
from mars2d.world.loop import Interrupted
from mars2d.world.record import Record

KINDS = {"video": "film", "html": "page"}
"""The words for output files whose argument has another name."""

FPS, SIZE = 25, (1280, 720)
"""Frames per second of a film, and its default size, pixels."""

DURATION = 12.0
"""The duration of a film for which no speed was given, seconds."""

Make = Callable[[], object]
"""A function that makes a film, or another file."""

Made = dict[str, Path]
"""The files that were made, by the names of their arguments."""


# -- films -----------------------------------------------------------------------------------------


def check_film(arguments: argparse.Namespace, scenario: Scenario, last: float) -> None:
    """Check the options of a film of a run that lasts `last` seconds. Raises InputError."""
    if arguments.video is not None:
        film.check_film(arguments.video, arguments.size or SIZE, FPS)
        speed = film_speed(scenario, arguments.speed)
        Cut.of(last, speed, FPS, arguments.start, arguments.end, "the run")
    else:
        refuse(arguments, "size from to", "needs --video OUT: it is of the film")


def picture_and_film(arguments: argparse.Namespace, folder: Path, stop_time: float) -> None:
    """Ask for a picture and a film of `DURATION` in a folder, where no window shows the run."""
    require_pygame("a film")
    folder.mkdir(exist_ok=True)
    stem = folder / experiment_name(Path(arguments.experiment))
    arguments.figure, arguments.video = stem.with_suffix(".png"), stem.with_suffix(".gif")
    arguments.speed = arguments.speed or max(stop_time / DURATION, 1e-9)


def film_speed(scenario: Scenario, speed: float | str | None) -> float:
    """Return a film's speed: as given, else the animation's, else that of a film of `DURATION`."""
    for choice in (speed, scenario.animation.playback_speed):
        if isinstance(choice, float) and choice > 0:
            return choice
    return max(scenario.stop_time / DURATION, 1e-9)


def save_film(
    record: Record, arguments: argparse.Namespace, drawings: Drawings | None = None
) -> None:
    """Make the requested film of a record, with a progress bar; drawings: of the run.

    The run may have ended before the part that is filmed does.
    """
    speed, end = film_speed(record.scenario, arguments.speed), arguments.end
    if end is not None and (record.time < end).all():
        end = None
    cut = film.cut_of(record, speed, FPS, arguments.start, end)
    drawn = (drawings or Drawings()).on
    frames = shots(
        cut, record.scenario.sampling_time, len(record) - 1, lambda row: drawn(record.frame(row))
    )
    look: dict[str, Any] = {"size": arguments.size or SIZE, "status": f"{speed:.3g}x"}
    with progress(cut.count, "frame") as update:
        film.save_film(frames, arguments.video, fps=FPS, progress=update, **look)


# -- a run and its files ---------------------------------------------------------------------------


def run_and_save(
    arguments: argparse.Namespace, run: Callable[[], Record], drawings: Drawings | None = None
) -> tuple[Record, Made, list[Mars2dError]]:
    """Run, and save all requested outputs however the run ends; return files and failures.

    run: returns the record. drawings: those of its add-ons, for the film. Ctrl-C ends the run and,
    once its data are saved, the other outputs. If an error ended the run, the data up to then are
    saved, their place is printed, and the error is raised.
    """
    ended: Mars2dError | Interrupted | None = None
    target: Path | None = arguments.record
    saving = "" if target is None else f"the run is being saved in {one_line(target)}"

    def rescue(kept: Record | None) -> None:
        if kept is not None and len(kept) and target is not None:
            _say_kept(*produced(arguments, {"record": lambda: save_record(target, kept)}), kept)

    with interrupts(held=saving, rescue=rescue):
        try:
            record = run()
        except (Mars2dError, Interrupted) as error:
            if error.record is None or not len(error.record):
                raise
            ended, record = error, error.record
        makers: dict[str, Make] = {"record": lambda: save_record(arguments.record, record)}
        made, troubles = produced(arguments, makers)

    times, end = arguments.at, float(record.time[-1]) if len(record) else 0.0
    if times is not None:  # the run may have ended before
        times = [*dict.fromkeys("end" if t == "end" or t > end else t for t in times)]
    makers = {
        "figure": lambda: figure.save_figure(record, arguments.figure, times),
        "html": lambda: record.save_html(arguments.html),
        "video": lambda: save_film(record, arguments, drawings),
    }
    others, more = produced(arguments, makers)
    made, troubles = made | others, troubles + more
    if ended is None:
        return record, made, troubles
    _say_kept(made, troubles, record)
    raise ended


def produced(
    arguments: argparse.Namespace, makers: Mapping[str, Make]
) -> tuple[Made, list[Mars2dError]]:
    """Make the requested outputs independently of each other; return files made, and errors."""
    made: Made = {}
    troubles = []
    for name, make in makers.items():
        if (path := getattr(arguments, name)) is not None:
            try:
                make()
                made[name] = path
            except Mars2dError as error:
                troubles.append(error)
    return made, troubles


def _say_kept(made: Made, troubles: Iterable[Mars2dError], record: Record) -> None:
    """Print errors of saving, and where the data of a run that was broken off are."""
    for trouble in troubles:
        warn(trouble)
    if made:
        files = ", ".join(one_line(path) for path in made.values())
        warn(f"what was recorded until {record.time[-1]:g} s is in {files}")


def conclude(made: Made, troubles: Sequence[Mars2dError]) -> None:
    """Print the files that were made, each with its kind; print all errors, and raise the last."""
    for name, path in made.items():
        tell(f"{KINDS.get(name, name) + ':':<8}{one_line(path)}")
    for trouble in troubles[:-1]:
        warn(trouble)
    if troubles:
        raise troubles[-1]


def outcome(record: Rows) -> dict[str, Any]:
    """Return how a run went, as JSON can hold it."""
    return {
        "ticks": max(len(record) - 1, 0),
        "time": float(record.time[-1]) if len(record) else 0.0,
        "collisions": record.collisions,
        "message": record.over_message,
        "digest": record.digest,
    }


def save_record(target: Path, record: Record) -> None:
    """Save the record, and those of its branches beside it; a log has been written already.

    If the record can't be saved in its place, it is kept elsewhere, and InputError says where.
    """
    if not formats.is_streamed(target):
        formats.save_or_rescue(record, target)
    elif not target.exists():
        place = formats.rescued(record, target)
        kept = "lost" if place is None else f"kept as {place}"
        raise InputError(f"{target}: is not there any more; the record is {kept}")
    for branch, saved in zip(record.branches, formats.save_branches(record, target), strict=True):
        end = f"left at {branch.time[-1]:g} s" if len(branch) else "empty"
        warn(f"another branch, {end}, is in {saved}")
