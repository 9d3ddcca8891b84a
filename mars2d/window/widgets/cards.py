"""Shelves of cards, each with a picture and a title, that scroll as one page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.rows import Pixel, Scroll, Word, write_line

WIDTH, GAP, MARGIN = 212.0, 18.0, 30.0
"""The least width of a card, the gap between two, and the margin of the page, points."""
LEAST = 100.0
"""The width of cards that are not made any narrower to be seen as a whole, points."""
SHAPE = 0.625
"""The height of a picture, in widths."""
CAPTION, HEADING = 32.0, 46.0
"""The heights of a card's title and of a shelf's, points."""
TITLE, LETTERS = 18.0, 14.5
"""The heights of letters of a shelf's title and of a card's, points."""
NOTCH = 0.1
"""How far a notch of the wheel scrolls, pages."""


@dataclass(frozen=True)
class Card:
    """Something to open.

    title: below its picture. line: says more. command: the arguments of ``mars2d`` that open it.
    picture: a file, or None. sign: drawn where there is no picture. words: more that is searched.
    others: further commands, by what the card's buttons say; the first one is of `command`.
    """

    title: str
    line: str
    command: tuple[str, ...]
    picture: Path | None = None
    sign: str = ""
    words: str = ""
    others: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def has(self, words: str) -> bool:
        """Return whether all words occur in it."""
        return _occur(words, f"{self.title} {self.line} {' '.join(self.command)} {self.words}")

    def is_called(self, words: str) -> bool:
        """Return whether all words occur in its title."""
        return _occur(words, self.title)


def _occur(words: str, text: str) -> bool:
    text = text.lower().replace("_", "")
    return all(word in text for word in words.lower().replace("_", "").split())


@dataclass(frozen=True)
class Shelf:
    """Cards under a title."""

    title: str
    cards: Sequence[Card] = field(default_factory=tuple)


class Page:
    """The shelves, where each card lies, and which is chosen."""

    def __init__(self) -> None:
        """Start empty, at the top."""
        self.places: list[tuple[Card, pygame.Rect]] = []
        self.buttons: list[tuple[pygame.Rect, tuple[str, ...]]] = []  # on the surface
        self.chosen = 0
        self._scroll = Scroll()
        self._area = pygame.Rect(0, 0, 0, 0)
        self._headings: list[tuple[str, pygame.Rect]] = []

    @property
    def card(self) -> Card | None:
        """The chosen card."""
        return self.places[self.chosen][0] if self.chosen < len(self.places) else None

    def arrange(self, shelves: Sequence[Shelf], area: pygame.Rect, ui: float) -> None:
        """Lay out all cards in columns of an area."""
        self._area = area
        margin, gap = round(MARGIN * ui), round(GAP * ui)
        room = area.width - 2 * margin
        high = max(area.height - (HEADING + CAPTION + GAP) * ui, SHAPE * LEAST * ui)
        widest = min(WIDTH * ui, high / SHAPE)  # so that a whole card is seen
        columns = max(1, int((room + gap) / (widest + gap)))
        width = min((room + gap) // columns - gap, round(high / SHAPE))
        height = round(SHAPE * width + CAPTION * ui)
        self.places, self._headings = [], []
        y = round(0.4 * margin)
        for shelf in shelves:
            heading = pygame.Rect(margin, y, room, round(HEADING * ui))
            self._headings.append((shelf.title, heading))
            y += heading.height
            for k, card in enumerate(shelf.cards):
                row, column = divmod(k, columns)
                left, top = margin + column * (width + gap), y + row * (height + gap)
                self.places.append((card, pygame.Rect(left, top, width, height)))
            y = self.places[-1][1].bottom + round(0.5 * gap) if self.places else y
        self.chosen = min(self.chosen, max(0, len(self.places) - 1))
        self._scroll.fit(y + margin, area.height)

    def turn(self, pages: float) -> None:
        """Scroll down by pages."""
        self._scroll.at += pages * self._area.height

    def move(self, right: int, down: int) -> None:
        """Choose a neighbour of the chosen card, and bring it into view."""
        if not self.places:
            return
        if right:
            self.chosen = min(max(self.chosen + right, 0), len(self.places) - 1)
        if down:
            here = self.places[self.chosen][1]
            beyond = [
                (abs(place.centery - here.centery), abs(place.centerx - here.centerx), k)
                for k, (_, place) in enumerate(self.places)
                if down * (place.centery - here.centery) > 0
            ]
            self.chosen = min(beyond)[2] if beyond else self.chosen
        place = self.places[self.chosen][1]
        above = 0 if place.top < 2 * place.height else place.top - place.height // 2
        self._scroll.bring(above, place.bottom + 20)

    def at(self, pixel: Pixel) -> int | None:
        """Return the number of the card at a pixel of the surface, if there is one."""
        inside = self._area.collidepoint(pixel)
        places = enumerate(self._seen(place) for _, place in self.places if inside)
        return next((k for k, place in places if place.collidepoint(pixel)), None)

    def draw(self, surface: pygame.Surface, painter: Painter) -> None:
        """Draw the visible cards, and the scroll bar."""
        self.buttons = []
        surface.set_clip(self._area)
        surface.fill(painter.theme.page, self._area)
        for title, place in self._headings:
            size, at = TITLE * painter.ui, self._seen(place).midleft
            painter.write(surface, title, size, painter.theme.ink, bold=True, midleft=at)
        for card, place in self.places:
            if self._seen(place).colliderect(self._area):
                self._draw_card(surface, painter, card, self._seen(place))
        self._scroll.draw_bar(surface, painter, self._area.inflate(-8 * painter.ui, 0))
        surface.set_clip(None)

    def _seen(self, place: pygame.Rect) -> pygame.Rect:
        return place.move(self._area.left, self._area.top - round(self._scroll.at))

    def _draw_card(
        self, surface: pygame.Surface, painter: Painter, card: Card, place: pygame.Rect
    ) -> None:
        ui, theme, fonts = painter.ui, painter.theme, painter.fonts
        if card is self.card:
            edge = max(2, round(2.5 * ui))
            painter.panel(surface, place.inflate(2 * edge, 2 * edge), theme.selected, 10 * ui)
        painter.panel(surface, place, theme.plate, 8 * ui, theme.edge)
        inset = round(6 * ui)
        shown = place.inflate(-2 * inset, 0)
        shown.top, shown.height = place.top + inset, place.height - inset - round(CAPTION * ui)
        image = None if card.picture is None else _image(card.picture, shown.size)
        if image is not None:
            surface.blit(image, shown)
        else:
            painter.panel(surface, shown, theme.page, 5 * ui)
            size = 0.42 * shown.height
            painter.write(surface, card.sign, size, theme.muted, center=shown.center)
        corner = shown.right - round(6 * ui), shown.bottom - round(6 * ui)
        for label, command in reversed([*card.others.items()]):
            width = fonts.width(label, LETTERS * ui) + round(18 * ui)
            button = pygame.Rect(0, 0, width, round(26 * ui))
            button.bottomright = corner
            painter.panel(surface, button, theme.plate, 6 * ui, theme.key_edge)
            painter.write(surface, label, LETTERS * ui, theme.ink, center=button.center)
            self.buttons.append((button, command))
            corner = button.left - round(6 * ui), button.bottom
        caption = pygame.Rect(shown.bottomleft, (shown.width, place.bottom - shown.bottom))
        write_line(surface, caption, painter, [Word(card.title, theme.text, LETTERS)])


@lru_cache(maxsize=128)
def _image(path: Path, size: tuple[int, int]) -> pygame.Surface | None:
    """Return the middle of the picture of a file in some size; None if it can't be read."""
    try:
        found = pygame.image.load(path)
    except (OSError, pygame.error):
        return None
    part = pygame.Rect(0, 0, *size).fit(found.get_rect())
    image = pygame.Surface(part.size, 0, 32)
    image.blit(found, (0, 0), part)
    return pygame.transform.smoothscale(image, size)
