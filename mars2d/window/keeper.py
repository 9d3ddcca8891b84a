"""What a person keeps of a window: pictures, films, the scenario as Python."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pygame

from mars2d.core.errors import InputError
from mars2d.core.scene import Scene
from mars2d.output.raster.camera import PIXELS
from mars2d.output.raster.painter import Painter
from mars2d.scenario.scenario import Scenario
from mars2d.window.keep import keep_picture, keep_python, start_film
from mars2d.window.notes import Notes

if TYPE_CHECKING:
    from mars2d.output.films.filming import Filming

__all__ = ["Keeper"]

FILMING = "#d62728"


class Keeper:
    """Writes files into the current folder, under names that are free, and tells where they are."""

    def __init__(self, notes: Notes, stem: str) -> None:
        """Take what tells it, and what files are called, without a number."""
        self._notes, self._stem = notes, stem
        self._film: Filming | None = None

    def picture(self, surface: pygame.Surface) -> None:
        """Save a picture."""
        self._try(lambda: f"picture: {keep_picture(surface, _here(), self._stem)}")

    def python(self, scenario: Scenario, control: Callable[[Any], Any] | None) -> None:
        """Save a scenario as a Python file; control: the law of its team."""

        def keep() -> str:
            path, copied = keep_python(scenario, _here(), self._stem, control)
            return f"scenario: {path}{', and on the clipboard' if copied else ''}"

        self._try(keep)

    def film_or_not(self) -> None:
        """Begin to film what is seen, or end it."""
        self._try(self._begin_film if self._film is None else self._end_film)

    def close(self) -> None:
        """End the film, if there is one."""
        if self._film is not None:
            self._try(self._end_film)

    @property
    def filming(self) -> bool:
        """Whether what is seen is filmed."""
        return self._film is not None

    def _begin_film(self) -> str:
        self._film = start_film(_here(), self._stem)
        return f"filming {self._film.path}; V ends the film"

    def _end_film(self) -> str:
        assert self._film is not None
        film, self._film = self._film, None
        return f"film: {film.stop()}"

    def film(self, screen: pygame.Surface, plot: pygame.Rect, painter: Painter) -> None:
        """Take what is seen for the film, if there is one, and then show that it is filmed."""
        if self._film is None:
            return
        try:
            self._film.take(screen)
        except InputError as error:
            self._film = None
            self._notes.say(str(error), "error")
            return
        scene, ui = Scene(), painter.ui
        place = plot.left + 22 * ui, -plot.top - 22 * ui
        scene.circle(place, 0.0, fill=FILMING, stroke="#ffffff", width=2.0, pixels=8.0)
        painter.paint(screen, scene.shapes, PIXELS, shaded=False)

    def _try(self, keep: Callable[[], str]) -> None:
        """Do something that tells what it has done, or why it can't be."""
        try:
            self._notes.say(keep())
        except InputError as error:
            self._notes.say(str(error), "error")


def _here() -> Path:
    try:
        return Path.cwd()
    except FileNotFoundError:
        raise InputError("the current folder is gone: no file can be made there") from None
