"""The verb ``paper``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from mars2d.core.errors import Mars2dError, counted
from mars2d.core.progress import Progress
from mars2d.core.streams import check_seed
from mars2d.core.terminal import tell
from mars2d.reports.paper.figure import Figure, Result
from mars2d.reports.paper.figures import FIGURES
from mars2d.reports.paper.folder import prepare, remove, write_page
from mars2d.reports.paper.make import make_all
from mars2d.reports.paper.page import verdict


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("folder", metavar="OUT", type=Path, help="a folder: new, empty, or of an earlier run")
    add("--only", type=_numbers, metavar="N1,N2,...", help="only these figures of 2 to 9")
    add("--seed", type=int, default=0, metavar="N", help="of all random streams")


def _numbers(text: str) -> list[int]:
    known = [figure.number for figure in FIGURES]
    try:
        numbers = {int(item) for item in text.split(",")}
    except ValueError:
        numbers = set()
    if not numbers or not numbers <= set(known):
        wanted = f"numbers of figures from {known[0]} to {known[-1]}, such as 4,7"
        raise argparse.ArgumentTypeError(f"{text!r}: expected {wanted}")
    return sorted(numbers)


def execute(arguments: argparse.Namespace) -> None:
    """Regenerate the figures of the MARS paper on a page that compares them with theory."""
    seed, folder = check_seed(arguments.seed), arguments.folder
    figures = [f for f in FIGURES if arguments.only is None or f.number in arguments.only]
    prepare(folder, [name for figure in FIGURES for name in figure.files])
    done: dict[int, Result] = {}
    progress = Progress(len(figures), after=0)

    def watch(count: int, active: Sequence[int]) -> None:
        progress.update(count, f"figure {' and '.join(map(str, active))}")

    try:
        make_all(figures, folder, seed, done, watch)
    finally:  # also after Ctrl-C: the page then shows the figures made so far
        progress.close()
        remove([name for f in figures if f.number not in done for name in f.files], folder)
        path = write_page(folder, figures, done, seed)
        _report(figures, done, path)
    broken = [number for number, result in sorted(done.items()) if result.problems]
    if broken:
        raise Mars2dError(f"not all was made: see figure {', '.join(map(str, broken))} above")


def _report(figures: Sequence[Figure], done: dict[int, Result], path: Path) -> None:
    """Print the verdict on each figure, failed predictions, and the page's path."""
    width = max(len(figure.title) for figure in figures)
    for figure in figures:
        result = done.get(figure.number)
        words = "not made" if result is None else verdict(result)
        tell(f"figure {figure.number}  {figure.title:<{width}}  {words}")
        if result is None:
            continue
        for problem in result.problems:
            tell(f"          {problem}")
        for picture in result.pictures:
            for p in picture.predictions:
                if not p.ok:
                    tell(f"          NOT OK: {picture.title}: {p.name}")
    failed = sum(result.failed for result in done.values())
    if failed:
        verb = "does" if failed == 1 else "do"
        tell(f"{counted(failed, 'prediction')} {verb} not hold")
    tell(f"page: {path}")
