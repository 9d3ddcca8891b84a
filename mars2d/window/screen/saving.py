"""Pictures, films and scenarios saved from a window; never over a file that exists."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pygame

from mars2d.core.errors import InputError
from mars2d.core.scene import Scene
from mars2d.output.formats import save_branches
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.picture import save_png
from mars2d.window.widgets.notes import Notes
from mars2d.world.record import Record

if TYPE_CHECKING:
    from mars2d.output.films.filming import Filming

MAX_STEM = 60
"""The longest name of a file without its number, characters."""
FILMING_COLOR = "#d62728"


class Saver:
    """Saves files in the current folder under free names, and reports each in a note.

    stem: what the files are called, without a number.
    """

    def __init__(self, notes: Notes, stem: str) -> None:
        """Start without a film."""
        self._notes, self._stem = notes, stem
        self._film: Filming | None = None

    def save(self, what: str, suffix: str, write: Callable[[Path], str | None]) -> bool:
        """Save something in a new file; return whether that worked.

        what: for the note. write: writes the file, and may return what more there is to say.
        """
        return self._try(lambda: f"{what}: {saved(_here(), self._stem, suffix, write)}")

    def picture(self, surface: pygame.Surface) -> None:
        """Save a picture."""
        self.save("picture", ".png", partial(save_png, surface))

    def record(self, record: Record) -> bool:
        """Save a run with its branches; return whether it could be."""

        def write(path: Path) -> str:
            record.save(path)
            return ", other branches beside it" if save_branches(record, path) else ""

        return self.save("run", ".npz", write)

    def film_or_not(self) -> None:
        """Start a film of the window, or end it."""
        self._try(self._begin_film if self._film is None else self._end_film)

    def close(self) -> None:
        """End the film, if one is being made."""
        if self._film is not None:
            self._try(self._end_film)

    @property
    def filming(self) -> bool:
        """Whether the window is being filmed."""
        return self._film is not None

    def _begin_film(self) -> str:
        from mars2d.output.films.filming import Filming, film_suffix

        self._film = Filming(free_name(_here(), self._stem, film_suffix()))
        return f"filming {self._film.path}; V ends the film"

    def _end_film(self) -> str:
        assert self._film is not None
        film, self._film = self._film, None
        try:
            return f"film: {film.stop()}"
        except InputError:
            film.path.unlink(missing_ok=True)  # it is broken
            raise

    def film(
        self, picture: pygame.Surface, screen: pygame.Surface, plot: pygame.Rect, painter: Painter
    ) -> None:
        """Add a picture to the film that is being made, and mark the screen as filmed."""
        assert self._film is not None
        try:
            self._film.take(picture)
        except InputError as error:
            broken = self._film.path
            with suppress(InputError):
                self._end_film()
            broken.unlink(missing_ok=True)
            self._notes.say(str(error), "error")
            return
        scene, ui = Scene(), painter.ui
        place = plot.left + 22 * ui, -plot.top - 22 * ui
        scene.circle(place, 0.0, fill=FILMING_COLOR, stroke="#ffffff", width=2.0, pixels=8.0)
        painter.paint(screen, scene.shapes, PIXELS, shaded=False)

    def _try(self, save: Callable[[], str]) -> bool:
        """Save something, and report it or the error in a note; return whether it worked."""
        try:
            self._notes.say(save())
        except InputError as error:
            self._notes.say(str(error), "error")
            return False
        return True


def free_name(folder: Path, stem: str, suffix: str) -> Path:
    """Create an empty file ``stem_1``, ``stem_2``, ..., whichever is free first; return its path.

    stem: any text, for example a title; only letters, digits, - and _ are kept. Raises InputError
    if no file can be created.
    """
    name = re.sub(r"[^\w-]+", "_", stem).strip("_").lower()[:MAX_STEM] or "scenario"
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


def saved(folder: Path, stem: str, suffix: str, write: Callable[[Path], str | None]) -> str:
    """Write a file under a free name, which is removed if that fails; return its path in words."""
    path = free_name(folder, stem, suffix)
    try:
        return f"{path}{write(path) or ''}"
    except BaseException:
        path.unlink(missing_ok=True)
        raise


def _here() -> Path:
    try:
        return Path.cwd()
    except FileNotFoundError:
        raise InputError("the current folder is gone: no file can be made there") from None
