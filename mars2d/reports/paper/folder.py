"""The folder that the figures go to: made if it is missing, and never one with other files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from mars2d.core.errors import InputError

__all__ = ["MARK", "NUMBERS", "PAGE", "prepare", "remove"]

PAGE, NUMBERS = "index.html", "numbers.json"

MARK = '<meta name="generator" content="mars2d paper">'
"""What tells a page of ours from others."""


def prepare(folder: Path, pictures: Iterable[str]) -> None:
    """Make the folder, or empty it of what an earlier run has left.

    pictures: the names of all files that a run may make, without page and numbers. Raises
    InputError for a folder with anything else in it (but hidden files, which are left alone), and
    for one that can't be written.
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
        probe.touch()  # so that a folder which can't be written is known before the first run
        probe.unlink()
    except OSError as error:
        raise InputError(f"{folder}: can't be written: {error.strerror}") from error


def _refuse_others(folder: Path, inside: list[Path], own: set[str]) -> None:
    """Raise InputError if anything in the folder was not made here."""
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
    """Remove those pictures of the folder that are there: the page does not show them."""
    for name in pictures:
        (folder / name).unlink(missing_ok=True)
