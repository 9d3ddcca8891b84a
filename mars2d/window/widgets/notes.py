"""What a window says: notes that fade."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import pygame

from mars2d.core.scene import faded
from mars2d.output.raster.painter import Painter

NoteKind = Literal["info", "warning", "error"]
TONES = {"info": "running", "warning": "waiting", "error": "error"}
"""The tones of the theme of notes, by their kinds."""

STAYS, FADES = 5.0, 0.7
"""How long a note is seen, and how long it fades at the end, seconds."""
NUMBER = re.compile(r"\d+(\.\d+)?")
MAX_NOTES = 4
MAX_LINES = 6
"""The number of lines in a note."""
MAX_WIDTH, MAX_WIDTH_SHARE = 420.0, 0.62
"""The widest note: in points, and as a share of the picture's width."""
MIN = 220.0, 120.0
"""The least width and height of a side of the picture for notes, points."""
SIZE, LINE = 14.0, 20.0
"""The heights of letters and lines, points."""


@dataclass(slots=True)
class _Note:
    text: str
    kind: NoteKind
    since: float | None = None  # when it was first drawn


class Notes:
    """Messages in the lower right corner of the picture, the newest at the bottom.

    An error stays until the next error replaces it or all notes are cleared: by Esc, or when a file
    is read without an error.
    """

    def __init__(self) -> None:
        """Start with nothing to say."""
        self._notes: list[_Note] = []

    def __len__(self) -> int:
        """Return the number of notes."""
        return len(self._notes)

    @property
    def failed(self) -> bool:
        """Whether one of the notes is an error."""
        return any(note.kind == "error" for note in self._notes)

    def say(self, text: str, kind: NoteKind = "info") -> None:
        """Add a note. It replaces one that differs at most in numbers; an error also an error."""
        alike = NUMBER.sub("", text)
        others = [note for note in self._notes if NUMBER.sub("", note.text) != alike]
        if kind == "error":
            others = [note for note in others if note.kind != "error"]
        self._notes = [*others, _Note(text, kind)][-MAX_NOTES:]

    def clear(self) -> None:
        """Remove all notes, errors too."""
        self._notes = []

    def draw(
        self,
        surface: pygame.Surface,
        plot: pygame.Rect,
        painter: Painter,
        now: float,
        free: Sequence[pygame.Rect] = (),
        off: tuple[float, float] | None = None,
    ) -> None:
        """Draw the notes that have not expired; now: a monotonic clock, seconds.

        free: sides of the picture on which they lie if there is room, such as beside panels. off: a
        pixel that they do not cover, that of what is selected: they then go to the left.
        """
        for note in self._notes:
            note.since = now if note.since is None else note.since
        self._notes = [note for note in self._notes if _opacity(note, now) > 0]
        ui, edge, gap = painter.ui, round(12 * painter.ui), round(8 * painter.ui)
        roomy = (side for side in free if side.width > MIN[0] * ui and side.height > MIN[1] * ui)
        area = next(roomy, plot)
        room = min(MAX_WIDTH * ui, MAX_WIDTH_SHARE * plot.width, area.width - 2 * edge)
        images = [(_opacity(note, now), _drawn(note, room, painter)) for note in self._notes]
        foot, wide = area.bottom - edge, max((each.get_width() for _, each in images), default=0)
        high = sum(image.get_height() + gap for _, image in images)
        whole = pygame.Rect(area.right - wide - 2 * edge, foot - high, wide + 2 * edge, high + edge)
        aside = off is not None and whole.collidepoint(off)
        for opacity, image in reversed(images):
            place = image.get_rect(bottomright=(area.right - edge, foot))
            if place.top < area.top + gap:
                break
            place.left = area.left + edge if aside else place.left
            image.set_alpha(round(255 * opacity))
            surface.blit(image, place)
            foot = place.top - gap


def _opacity(note: _Note, now: float) -> float:
    """Return the opacity of a note, from 0 to 1."""
    if note.kind == "error" or note.since is None:
        return 1.0
    return min(max((note.since + STAYS - now) / FADES, 0.0), 1.0)


def _drawn(note: _Note, room: float, painter: Painter) -> pygame.Surface:
    """Return a note on a transparent surface: a plate with a bar of its colour at the left.

    room: the width that it may have, pixels.
    """
    ui, fonts, theme = painter.ui, painter.fonts, painter.theme
    lines = fonts.wrap(note.text, SIZE * ui, room - 36 * ui, MAX_LINES)
    width = max(fonts.width(line, SIZE * ui) for line in lines) + round(36 * ui)
    size = round(width), round((LINE * len(lines) + 18) * ui)
    image = pygame.Surface(size, pygame.SRCALPHA, 32)
    plate = image.get_rect()
    painter.panel(image, plate, faded(theme.plate, 0.96), 8 * ui, theme.edge)
    bar = pygame.Rect(round(8 * ui), 0, max(2, round(4 * ui)), size[1] - round(16 * ui))
    bar.centery = plate.centery
    painter.panel(image, bar, getattr(theme, TONES[note.kind]).ink, bar.width / 2)
    for k, line in enumerate(lines):
        middle = (22 * ui, (9 + LINE * (k + 0.5)) * ui)
        painter.write(image, line, SIZE * ui, theme.ink, midleft=middle)
    return image
