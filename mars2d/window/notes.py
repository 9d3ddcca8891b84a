"""Short messages over the picture, which fade by themselves; and how far something long has got."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import pygame

from mars2d.core.scene import faded
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import Theme

__all__ = ["Notes", "Progress", "draw_progress"]

NoteKind = Literal["info", "warning", "error"]

STAYS, FADES = 5.0, 0.7
"""A note is seen for so many seconds, and fades in the last ones."""
MOST = 4
"""Notes at a time."""
LINES = 6
WIDTH = 420.0
"""Of a note, points, at most."""
SHARE = 0.62
"""Of a note, of the picture's width, at most."""
SIZE, LINE = 14.0, 20.0
"""The heights of letters and lines, points."""


@dataclass(slots=True)
class _Note:
    text: str
    kind: NoteKind
    since: float | None = None  # when it was first drawn


class Notes:
    """Messages in the lower right corner of the picture, the newest lowest.

    An error stays until another one replaces it, or until all are cleared: in the window by Esc,
    or by a file that is read without one.
    """

    def __init__(self) -> None:
        """Start with nothing to say."""
        self._notes: list[_Note] = []

    def __len__(self) -> int:
        """Return how many are there to be drawn."""
        return len(self._notes)

    @property
    def failed(self) -> bool:
        """Whether there is an error among them."""
        return any(note.kind == "error" for note in self._notes)

    def say(self, text: str, kind: NoteKind = "info") -> None:
        """Add a message; one that says the same goes, and an error for an error."""
        self._notes = [
            note for note in self._notes if note.text != text and not (kind == note.kind == "error")
        ]
        self._notes = [*self._notes, _Note(text, kind)][-MOST:]

    def clear(self) -> None:
        """Remove all, errors too."""
        self._notes = []

    def draw(
        self, surface: pygame.Surface, plot: pygame.Rect, painter: Painter, now: float
    ) -> None:
        """Draw what is not over yet; now: seconds on a clock that goes on."""
        ui = painter.ui
        for note in self._notes:
            note.since = now if note.since is None else note.since
        self._notes = [note for note in self._notes if _opacity(note, now) > 0]
        foot = plot.bottom - round(12 * ui)
        for note in reversed(self._notes):
            image = _drawn(note, plot, painter)
            top = foot - image.get_height()
            if top < plot.top + round(8 * ui):
                break
            image.set_alpha(round(255 * _opacity(note, now)))
            surface.blit(image, (plot.right - round(12 * ui) - image.get_width(), top))
            foot = top - round(8 * ui)


def _opacity(note: _Note, now: float) -> float:
    """Return how much of a note is seen, from 0 to 1."""
    if note.kind == "error" or note.since is None:
        return 1.0
    return min(max((note.since + STAYS - now) / FADES, 0.0), 1.0)


def _drawn(note: _Note, plot: pygame.Rect, painter: Painter) -> pygame.Surface:
    """Return a note on a transparent surface: a plate with a bar of its colour at the left."""
    ui, fonts, theme = painter.ui, painter.fonts, painter.theme
    room = min(WIDTH * ui, SHARE * plot.width) - 36 * ui
    lines = fonts.wrap(note.text, SIZE * ui, room, LINES)
    width = max(fonts.width(line, SIZE * ui) for line in lines) + round(36 * ui)
    size = round(width), round((LINE * len(lines) + 18) * ui)
    image = pygame.Surface(size, pygame.SRCALPHA, 32)
    plate = image.get_rect()
    painter.panel(image, plate, faded(theme.plate, 0.96), 8 * ui, theme.edge)
    bar = pygame.Rect(round(8 * ui), 0, max(2, round(4 * ui)), size[1] - round(16 * ui))
    bar.centery = plate.centery
    painter.panel(image, bar, _color(note.kind, theme), bar.width / 2)
    for k, line in enumerate(lines):
        text = fonts.render(line, SIZE * ui, theme.ink)
        middle = round((9 + LINE * (k + 0.5)) * ui)
        image.blit(text, text.get_rect(midleft=(round(22 * ui), middle)))
    return image


def _color(kind: NoteKind, theme: Theme) -> str:
    tones = {"info": theme.running, "warning": theme.waiting, "error": theme.error}
    return tones[kind].ink


@dataclass(frozen=True, slots=True)
class Progress:
    """Something that takes a while, in words, and which share of it is done, from 0 to 1."""

    text: str
    share: float


def draw_progress(
    surface: pygame.Surface, plot: pygame.Rect, painter: Painter, progress: Progress
) -> None:
    """Draw a line of words with a bar below it, in the middle of the picture's foot."""
    ui, fonts, theme = painter.ui, painter.fonts, painter.theme
    share = min(max(progress.share, 0.0), 1.0)
    pad, percent = round(18 * ui), f"{100 * share:.0f} %"
    most = min(WIDTH * ui, plot.width - 4 * pad)
    number = fonts.width("100 %", 15 * ui, bold=True) + round(14 * ui)
    text = fonts.shorten(progress.text, 15 * ui, most - number)
    width = max(fonts.width(text, 15 * ui) + number, round(min(260 * ui, most)))
    plate = pygame.Rect(0, 0, width + 2 * pad, round(60 * ui))
    plate.midbottom = (plot.centerx, plot.bottom - round(16 * ui))
    painter.panel(surface, plate, theme.plate, 10 * ui, theme.edge)
    middle = plate.top + round(23 * ui)
    image = fonts.render(text, 15 * ui, theme.ink)
    surface.blit(image, image.get_rect(midleft=(plate.left + pad, middle)))
    image = fonts.render(percent, 15 * ui, theme.running.ink, bold=True)
    surface.blit(image, image.get_rect(midright=(plate.right - pad, middle)))
    line = pygame.Rect(plate.left + pad, plate.top + round(41 * ui), width, round(6 * ui))
    painter.panel(surface, line, theme.track, line.height / 2)
    before = surface.get_clip()
    surface.set_clip(pygame.Rect(line.left, line.top, round(share * line.width), line.height))
    painter.panel(surface, line, theme.selected, line.height / 2)
    surface.set_clip(before)
