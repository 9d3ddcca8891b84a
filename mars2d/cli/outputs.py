"""The output files of a run: those of --record, --figure, --video and --html."""

from __future__ import annotations

import argparse
import os
import re
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from mars2d.cli.arguments import times
from mars2d.cli.films import Film, add_film, save_film_of
from mars2d.core.errors import InputError, Mars2dError, one_line
from mars2d.core.files import why_unwritable
from mars2d.core.interrupt import interrupts
from mars2d.core.terminal import tell, warn
from mars2d.output import formats
from mars2d.output.figures import figure
from mars2d.output.films import film
from mars2d.output.films.mp4 import require_av
from mars2d.output.raster import require_pygame
from mars2d.world.loop import Interrupted
from mars2d.world.record import Record

OUTPUTS = {
    "record": tuple(formats.FORMATS),
    "figure": figure.SUFFIXES,
    "video": film.SUFFIXES,
    "html": (".html", ".htm"),
}
"""The arguments that name output files, with their possible suffixes."""

HAIR = 1e-9
"""A time so little after the end, as a share of it, is the end: 600 * 0.1 is not quite 60."""

KINDS = {"record": "record", "figure": "figure", "video": "film", "html": "page"}
"""The words for the output files."""

Made = dict[str, Path]
"""The files that were made, by the names of their arguments."""


def add_pictures(parser: argparse.ArgumentParser) -> None:
    """Add the figure with its snapshots, the film and the page."""
    add = parser.add_argument
    add("--figure", type=Path, metavar="OUT", help="draw the paths: .png, .pdf, .svg")
    add("--at", type=times, metavar="T1,T2,...", help="draw snapshots at these times instead")
    add_film(parser)
    add_html(parser)


def add_html(parser: argparse.ArgumentParser) -> None:
    """Add the replay as an HTML page."""
    parser.add_argument(
        "--html", type=Path, metavar="OUT.html", help="a replay for any browser, in one file"
    )


def check_outputs(arguments: argparse.Namespace, outputs: Mapping[str, tuple[str, ...]]) -> None:
    """Raise InputError before the run for an output file that can't be written after it.

    outputs: the names of arguments that name files, with their possible suffixes.
    """
    for name, suffixes in outputs.items():
        path: Path | None = getattr(arguments, name)
        if path is None:
            continue
        if path.suffix.lower() not in suffixes:
            wanted = " or ".join(suffixes)
            raise InputError(f"--{name} {path}: expected a name that ends in {wanted}")
        if not path.parent.is_dir():
            raise InputError(f"--{name} {path}: there is no folder {path.parent}")
        if not os.access(path.parent, os.W_OK):
            raise InputError(f"--{name} {path}: nothing can be written in {path.parent.absolute()}")
        why = why_unwritable(path)
        if why:
            raise InputError(f"--{name} {path}: can't be written: {why}")
        if name == "video":
            require_pygame("a film")
            if path.suffix.lower() == ".mp4":
                require_av(path)
        if name == "record":
            formats.require(path)


def check_snapshots(arguments: argparse.Namespace) -> None:
    """Raise InputError for times of snapshots without a figure."""
    if arguments.at is not None and arguments.figure is None:
        raise InputError("--at needs --figure OUT")


def run_and_save(
    arguments: argparse.Namespace, run: Callable[[], tuple[Record, Film | None]]
) -> tuple[Record, Made, list[Mars2dError]]:
    """Run, and save all requested outputs however the run ends; return files and failures.

    run: returns the record, and a function that makes the film unless it is made from the record.
    Ctrl-C ends the run and, once its data are saved, the other outputs. If an error ended the run,
    the data up to then are saved, their place is printed, and the error is raised.
    """
    ended: Mars2dError | Interrupted | None = None
    film: Film | None = None
    target: Path | None = arguments.record
    saving = "" if target is None else f"the run is being saved in {one_line(target)}"
    with interrupts(held=saving, rescue=lambda kept: _rescue(arguments, kept)):
        try:
            record, film = run()
        except (Mars2dError, Interrupted) as error:
            if error.record is None or not len(error.record):
                raise
            ended, record = error, error.record
        made, troubles = _tried(arguments, {"record": lambda: save_record(arguments, record)})
    makers: dict[str, Film] = {
        "figure": lambda: _save_figure(arguments, record),
        "html": lambda: record.save_html(arguments.html),
        "video": film or (lambda: save_film_of(record, arguments)),
    }
    others, more = _tried(arguments, makers)
    made, troubles = made | others, troubles + more
    if ended is None:
        return record, made, troubles
    say(troubles)
    if made:
        files = ", ".join(map(str, made.values()))
        warn(f"what was recorded until {record.time[-1]:g} s is in {files}")
    raise ended


def _rescue(arguments: argparse.Namespace, record: Record | None) -> None:
    """Save the record of a run that does not end."""
    if record is None or not len(record) or arguments.record is None:
        return
    _, troubles = _tried(arguments, {"record": lambda: save_record(arguments, record)})
    say(troubles)
    if not troubles:
        warn(f"what was recorded until {record.time[-1]:g} s is in {one_line(arguments.record)}")


def _tried(
    arguments: argparse.Namespace, makers: Mapping[str, Film]
) -> tuple[Made, list[Mars2dError]]:
    """Make the requested outputs independently of each other; return files made, and errors."""
    made: Made = {}
    troubles = []
    for name, make in makers.items():
        path: Path | None = getattr(arguments, name)
        if path is None:
            continue
        try:
            make()
        except Mars2dError as error:
            troubles.append(error)
        else:
            made[name] = path
    return made, troubles


def tell_files(made: Made) -> None:
    """Print the files that were made, each with its kind."""
    for name, path in made.items():
        tell(f"{KINDS[name] + ':':<8}{one_line(path)}")


def say(troubles: Iterable[Mars2dError]) -> None:
    """Print errors of saving, unless the command ends with them."""
    for trouble in troubles:
        warn(trouble)


def save_record(arguments: argparse.Namespace, record: Record) -> None:
    """Save the record, and those of its branches beside it; a log has been written already.

    If the record can't be saved in its place, it is kept elsewhere, and InputError says where.
    """
    target: Path = arguments.record
    if not formats.is_streamed(target):
        formats.save_or_rescue(record, target)
    elif not target.exists():
        place = formats.rescued(record, target)
        kept = "lost" if place is None else f"kept as {place}"
        raise InputError(f"{target}: is not there any more; the record is {kept}")
    for branch, saved in zip(record.branches, formats.save_branches(record, target), strict=True):
        end = f"left at {branch.time[-1]:g} s" if len(branch) else "empty"
        warn(f"another branch, {end}, is in {saved}")


def _save_figure(arguments: argparse.Namespace, record: Record) -> None:
    times = _times_within(arguments.at, record)
    with naming_lost_letters():
        figure.save_figure(record, arguments.figure, times)


@contextmanager
def naming_lost_letters() -> Iterator[None]:
    """Replace matplotlib's long warnings of missing glyphs by one line that lists them."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.filterwarnings("always", message="Glyph ")
        yield
    lost: dict[str, None] = {}
    for each in caught:
        glyph = re.match(r"Glyph (\d+) ", str(each.message))
        if glyph:
            lost[repr(chr(int(glyph[1])))] = None
        else:
            warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)
    if lost:
        warn(f"no font has {', '.join(lost)}: boxes stand for them")


def _times_within(times: list[float | str] | None, record: Record) -> list[float | str] | None:
    """Return the times up to the end of a run, which may have ended early, and then its end."""
    if times is None:
        return None
    end = float(record.time[-1])
    beyond = [t for t in times if not isinstance(t, str) and t > end + HAIR * abs(end)]
    if not beyond:
        return times
    warn(f"the run ended at {end:g} s, which is drawn for {', '.join(f'{t:g}' for t in beyond)} s")
    within = [t for t in times if t not in beyond and t != "end"]
    return [*within, "end"]
