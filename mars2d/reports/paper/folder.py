"""The folder of the figures, with its page and numbers; it never holds other files."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.reports.paper.figure import Figure, Result
from mars2d.reports.paper.page import MARK, NUMBERS, page

PAGE = "index.html"
"""The page's file."""


def prepare(folder: Path, pictures: Iterable[str]) -> None:
    """Make the folder, or remove the files of an earlier run from it.

    pictures: the names of all files that a run may make, without page and numbers. Raises
    InputError for a folder with other files (except hidden ones, which are left alone), and for
    one that can't be written.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: this is a file; expected a folder")
    if not folder.absolute().parent.is_dir():
        raise InputError(f"{folder}: there is no folder {folder.parent}")
    try:
        folder.mkdir(exist_ok=True)
        inside = sorted(path for path in folder.iterdir() if not path.name.startswith("."))
        _refuse_others(folder, inside, {*pictures, PAGE, NUMBERS})
        for path in inside:
            path.unlink()
        probe = folder / ".mars2d"
        probe.touch()  # to find out now, before the first run, whether it can be written
        probe.unlink()
    except OSError as error:
        raise InputError(f"{folder}: can't be written: {error.strerror}") from error


def _refuse_others(folder: Path, inside: list[Path], own: set[str]) -> None:
    """Raise InputError if a file in the folder was not made by this command."""
    for path in inside:
        ours = path.name in own and path.is_file()
        if ours and path.name == PAGE:
            ours = MARK in path.read_text(encoding="utf-8", errors="replace")
        if not ours:
            raise InputError(
                f"{folder}: holds {path.name}, which is not of `mars2d paper`; nothing was "
                "changed. Name a new folder, or an empty one"
            )


def remove(pictures: Iterable[str], folder: Path) -> None:
    """Remove pictures from the folder, if they exist: the page does not show them."""
    for name in pictures:
        (folder / name).unlink(missing_ok=True)


def write_page(folder: Path, figures: Sequence[Figure], done: dict[int, Result], seed: int) -> Path:
    """Write the page and the numbers of the figures that were made; return the page's path."""
    results = [done[figure.number] for figure in figures if figure.number in done]
    numbers = {"seed": seed, "figures": [result.as_dict() for result in results]}
    texts = {
        NUMBERS: json.dumps(numbers, indent=1, allow_nan=False) + "\n",
        PAGE: page(figures, done, seed),
    }
    for name, text in texts.items():
        with atomic_write(folder / name) as file:
            file.write(text.encode())
    return folder / PAGE
