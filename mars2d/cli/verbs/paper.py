"""The verb ``paper``."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import option, shared, value
from mars2d.core.errors import Mars2dError, counted
from mars2d.core.progress import progress
from mars2d.core.streams import check_seed
from mars2d.core.terminal import tell
from mars2d.reports.paper.figures import FIGURES, Result
from mars2d.reports.paper.make import finish, make, prepare


def _numbers(text: str) -> list[int]:
    numbers = {int(item) for item in text.split(",")}
    if not numbers <= {figure.number for figure in FIGURES}:
        raise ValueError(text)
    return sorted(numbers)


_ONLY = value(_numbers, "numbers of figures from 2 to 9, such as 4,7")

ARGUMENTS = {
    "folder": option("OUT", "a folder: new, empty, or of an earlier run", Path),
    "--only": option("N1,N2,...", "only these figures of 2 to 9", _ONLY),
    **shared("seed"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Regenerate the figures of the MARS paper on a page that compares them with theory."""
    seed, folder = check_seed(arguments.seed), arguments.folder
    figures = [f for f in FIGURES if arguments.only is None or f.number in arguments.only]
    prepare(folder)
    done: list[Result] = []
    with progress(len(figures), "figure") as update:
        for figure in figures:
            done.append(make(figure, folder, seed))
            update(len(done), f"figure {figure.number} is made")
    path = finish(folder, done, seed)
    width = max(len(figure.title) for figure in figures)
    for result in done:
        _report(result, width)
    if failed := sum(result.failed for result in done):
        tell(f"{counted(failed, 'prediction')} {'does' if failed == 1 else 'do'} not hold")
    tell(f"page: {path}")
    if broken := ", ".join(str(result.figure.number) for result in done if result.problems):
        raise Mars2dError(f"not all was made: see figure {broken} above")


def _report(result: Result, width: int) -> None:
    """Print the verdict on a figure, and its failed predictions."""
    tell(f"figure {result.figure.number}  {result.figure.title:<{width}}  {result.verdict}")
    for problem in result.problems:
        tell(f"          {problem}")
    for picture in result.pictures:
        for p in picture.predictions:
            if p.ok is False:
                tell(f"          NOT OK: {picture.title}: {p.name}")
