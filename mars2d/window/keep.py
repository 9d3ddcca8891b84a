"""What is kept of a window: pictures, films, scenarios as Python; never over another file."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import pygame

from mars2d.core.errors import InputError
from mars2d.output.raster.picture import save_png
from mars2d.scenario.python_file import as_python
from mars2d.scenario.scenario import Scenario

if TYPE_CHECKING:
    from mars2d.output.films.filming import Filming

__all__ = ["Listing", "free_name", "keep_picture", "keep_python", "start_film"]

LONGEST = 60
"""Characters of a name without its number."""


class Listing(NamedTuple):
    """Where a scenario was written as Python, and whether it is on the clipboard as well."""

    path: Path
    copied: bool


def free_name(folder: Path, stem: str, suffix: str) -> Path:
    """Return the first of ``stem_1``, ``stem_2``, ... that is free, with an empty file made there.

    stem: any text, such as a title: letters, digits, - and _ of it are kept. Raises InputError
    where no file can be made.
    """
    name = re.sub(r"[^\w-]+", "_", stem).strip("_").lower()[:LONGEST] or "scenario"
    number = 1
    while True:
        path = folder / f"{name}_{number}{suffix}"
        try:
            path.open("xb").close()
        except FileExistsError:
            number += 1
        except OSError as error:
            where = folder.absolute()
            raise InputError(f"{where}: no file can be made here, {error.strerror}") from None
        else:
            return path


def keep_picture(surface: pygame.Surface, folder: Path, stem: str) -> Path:
    """Write a picture as PNG under a free name and return its path."""
    path = free_name(folder, stem, ".png")
    with _gone_if_not_written(path):
        save_png(surface, path)
    return path


def keep_python(
    scenario: Scenario, folder: Path, stem: str, control: Callable[[Any], Any] | None = None
) -> Listing:
    """Write a scenario as Python under a free name, and put it on the clipboard where there is one.

    control: the law of the team.
    """
    text = as_python(scenario, control, folder)
    path = free_name(folder, stem, ".py")
    with _gone_if_not_written(path):
        try:
            path.write_text(text, encoding="utf-8", newline="\n", errors="replace")
        except OSError as error:
            raise InputError(f"{path}: can't be written, {error.strerror or error}") from None
    return Listing(path, _copied(text))


def start_film(folder: Path, stem: str) -> Filming:
    """Begin a film under a free name: .mp4 if PyAV is installed, else .gif."""
    from mars2d.output.films.filming import Filming, film_suffix

    return Filming(free_name(folder, stem, film_suffix()))


@contextlib.contextmanager
def _gone_if_not_written(path: Path) -> Iterator[None]:
    """Remove a file again where writing it fails."""
    try:
        yield
    except BaseException:
        path.unlink(missing_ok=True)
        raise


def _copied(text: str) -> bool:
    """Put text on the clipboard; return whether that worked."""
    if not pygame.display.get_init() or pygame.display.get_surface() is None:
        return False
    try:
        pygame.scrap.put_text(text)
        return bool(pygame.scrap.get_text() == text)
    except pygame.error:
        return False
