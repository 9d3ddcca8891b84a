"""Pictures, films and scenarios saved from a window; never over a file that exists."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pygame

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.core.scene import Scene
from mars2d.output.formats import save_branches
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.picture import save_png
from mars2d.scenario.python_file import as_python
from mars2d.scenario.scenario import Scenario
from mars2d.window.widgets.clipboard import copied
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

    def picture(self, surface: pygame.Surface) -> None:
        """Save a picture."""
        self._try(lambda: f"picture: {save_picture(surface, _here(), self._stem)}")

    def python(
        self,
        scenario: Scenario,
        control: Callable[[Any], Any] | None,
        options: Mapping[str, Any] | None = None,
    ) -> None:
        """Save a scenario as a Python file; see `save_python`."""

        def save() -> str:
            path, copied = save_python(scenario, _here(), self._stem, control, options)
            return f"scenario: {path}{', and on the clipboard' if copied else ''}"

        self._try(save)

    def record(self, record: Record) -> bool:
        """Save a run with its branches; return whether it could be."""

        def save() -> str:
            path = free_name(_here(), self._stem, ".npz")
            with _removed_on_failure(path):
                record.save(path)
            beside = ", other branches beside it" if save_branches(record, path) else ""
            return f"run: {path}{beside}"

        return self._try(save)

    def figure(self, draw: Callable[[], Any]) -> None:
        """Save the figure of matplotlib that `draw` returns."""

        def save() -> str:
            from mars2d.output.figures.figure import save_drawing

            path = free_name(_here(), self._stem, ".png")
            with _removed_on_failure(path):
                return f"figure: {save_drawing(draw, path)}"

        self._try(save)

    def table(self, write: Callable[[], str]) -> None:
        """Save a table, the text of a CSV file that `write` returns."""

        def save() -> str:
            text, path = write().encode(), free_name(_here(), self._stem, ".csv")
            with _removed_on_failure(path), atomic_write(path) as file:
                file.write(text)
            return f"numbers: {path}"

        self._try(save)

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
        self._film = start_film(_here(), self._stem)
        return f"filming {self._film.path}; V ends the film"

    def _end_film(self) -> str:
        assert self._film is not None
        film, self._film = self._film, None
        return f"film: {film.stop()}"

    def film(
        self, picture: pygame.Surface, screen: pygame.Surface, plot: pygame.Rect, painter: Painter
    ) -> None:
        """Add a picture to the film that is being made, and mark the screen as filmed."""
        assert self._film is not None
        try:
            self._film.take(picture)
        except InputError as error:
            self._film = None
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


def save_picture(surface: pygame.Surface, folder: Path, stem: str) -> Path:
    """Write a picture as PNG under a free name and return its path."""
    path = free_name(folder, stem, ".png")
    with _removed_on_failure(path):
        save_png(surface, path)
    return path


def save_python(
    scenario: Scenario,
    folder: Path,
    stem: str,
    control: Callable[[Any], Any] | None = None,
    options: Mapping[str, Any] | None = None,
) -> tuple[Path, bool]:
    """Write a scenario as Python under a free name, and copy it to the clipboard if there is one.

    control: the law of the team. options: the parameters that were set, for a comment. Returns the
    path, and whether the clipboard has the text.
    """
    text = as_python(scenario, control, folder, options)
    path = free_name(folder, stem, ".py")
    with _removed_on_failure(path), atomic_write(path) as file:
        file.write(text.encode(errors="replace"))
    return path, copied(text)


def start_film(folder: Path, stem: str) -> Filming:
    """Start a film under a free name: .mp4 if PyAV is installed, else .gif."""
    from mars2d.output.films.filming import Filming, film_suffix

    return Filming(free_name(folder, stem, film_suffix()))


@contextlib.contextmanager
def _removed_on_failure(path: Path) -> Iterator[None]:
    """Remove a file if writing it fails."""
    try:
        yield
    except BaseException:
        path.unlink(missing_ok=True)
        raise


def _here() -> Path:
    try:
        return Path.cwd()
    except FileNotFoundError:
        raise InputError("the current folder is gone: no file can be made there") from None
