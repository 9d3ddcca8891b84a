"""What a run leaves behind: the files that are asked for by --record, --figure, --video, --html."""

from __future__ import annotations

import argparse
import os
import re
import sys
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from pathlib import Path

from mars2d import formats
from mars2d.commands.films import save_film_of
from mars2d.errors import InputError, Mars2dError
from mars2d.output import figure, film
from mars2d.record import Record
from mars2d.view import require_pygame

__all__ = ["OUTPUTS", "add_html", "check_outputs", "keep", "naming_lost_letters", "save_all",
           "save_data"]  # fmt: skip

OUTPUTS = {
    "record": formats.SUFFIXES,
    "figure": figure.SUFFIXES,
    "video": film.SUFFIXES,
    "html": (".html", ".htm"),
}
"""The arguments that name files, and the suffixes that these may have."""


def add_html(parser: argparse.ArgumentParser) -> None:
    """Add the replay as a page."""
    parser.add_argument(
        "--html", type=Path, metavar="OUT.html", help="a replay for any browser, in one file"
    )


def check_outputs(arguments: argparse.Namespace, outputs: Mapping[str, tuple[str, ...]]) -> None:
    """Refuse a file that can't be written before the run, not after it.

    outputs: arguments that name files, and the suffixes that they may have.
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
        if path.is_dir():
            raise InputError(f"--{name} {path}: this is a folder")
        if not os.access(path.parent, os.W_OK):
            raise InputError(f"--{name} {path}: nothing can be written in {path.parent.absolute()}")
        if name == "video":
            require_pygame("a film")
            if path.suffix.lower() == ".mp4":
                film.require_av(path)
        if name == "record":
            formats.require(path)


def keep(arguments: argparse.Namespace, record: Record) -> None:
    """Save what was recorded until an error, which is the one that counts, and say so."""
    try:
        save_all(arguments, record)
    except Mars2dError as error:
        print(f"mars2d: {error}", file=sys.stderr)
    else:
        made = [str(path) for name in OUTPUTS if (path := getattr(arguments, name)) is not None]
        if made:
            what = f"what was recorded until {record.time[-1]:g} s is in {', '.join(made)}"
            print(f"mars2d: {what}", file=sys.stderr)


def save_all(arguments: argparse.Namespace, record: Record) -> None:
    """Save what is asked for, the film made of the record."""
    save_data(arguments, record)
    if arguments.video is not None:
        save_film_of(record, arguments)


def save_data(arguments: argparse.Namespace, record: Record) -> None:
    """Save the record, those of branches beside it, the figure and the page, where asked for."""
    target: Path | None = arguments.record
    if target is not None:
        if target.suffix.lower() != formats.STREAMED:
            record.save(target)
        for branch in record.branches:
            saved = branch.save(_free_beside(target))
            end = f"left at {branch.time[-1]:g} s" if len(branch) else "empty"
            print(f"mars2d: another branch, {end}, is in {saved}", file=sys.stderr)
    if arguments.figure is not None:
        times = _times_within(arguments.at, record)
        with naming_lost_letters():
            figure.save_figure(record, arguments.figure, times)
    if arguments.html is not None:
        record.save_html(arguments.html)


@contextmanager
def naming_lost_letters() -> Iterator[None]:
    """Say in one line which characters no font has, where matplotlib warns of each at length."""
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
        print(f"mars2d: no font has {', '.join(lost)}: boxes stand for them", file=sys.stderr)


def _free_beside(path: Path) -> Path:
    """Return where a branch of a run is kept: no file is overwritten."""
    names = (path.with_stem(f"{path.stem}_branch{k}") for k in count(1))
    return next(beside for beside in names if not beside.exists())


def _times_within(times: list[float] | None, record: Record) -> list[float] | None:
    """Return those times that a run lasted for; it may have ended early."""
    if times is None:
        return None
    end = float(record.time[-1])
    within = [moment for moment in times if moment <= end]
    if len(within) < len(times):
        print(f"mars2d: the run ended at {end:g} s: no snapshots after it", file=sys.stderr)
    return within or None
