"""Menus over the picture: of layers to show, of actions on a body, of values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.actions import CONTROL, MODIFIERS, label_of

ROW, MORE, PAD, BOX = 30.0, 18.0, 8.0, 15.0
"""The heights of an entry and of a line below it, the margin, a tick box's side, points."""
SIZE, SMALL = 14.5, 12.5
"""The heights of letters of an entry and of the line below it, points."""
TICK = [(0.22, 0.52), (0.42, 0.74), (0.80, 0.26)]


class Entry(NamedTuple):
    """An entry of a menu.

    act: its effect; None for a title. key: the label of a key that has the same effect. on: whether
    its tick box is ticked; None for none. colors: of dots before the title. value: what is written
    at its right. more: a line below it.
    """

    title: str
    act: Callable[[], object] | None = None
    key: str = ""
    on: bool | None = None
    colors: Sequence[str] = ()
    value: str = ""
    more: str = ""


class Menu:
    """A list of entries on a plate, which takes all keys while it is open.

    Arrow keys and Enter choose, as do the mouse, the keys named beside the entries, and the first
    letters of a title. Esc, a click elsewhere, and commands with Ctrl or a function key close it.
    One with tick boxes stays open until then.

    name: of what is open, or "". corner: where it was opened, pixels. plate: where it was drawn.
    """

    def __init__(self) -> None:
        """Start closed."""
        self._entries: Callable[[], Sequence[Entry]] | None = None
        self.name, self.corner = "", (0, 0)
        self.plate = pygame.Rect(0, 0, 0, 0)
        self._places: list[tuple[int, Entry, pygame.Rect]] = []
        self._chosen, self._typed = 0, ""  # the number of an entry; letters typed so far
        self._first = 0  # the entry at the top, where there is no room for all
        self._stays = False

    @property
    def is_open(self) -> bool:
        """Whether it is open."""
        return self._entries is not None

    @property
    def chosen(self) -> str:
        """The title of the entry that Enter chooses, "" for none."""
        entries = self._listed()
        return entries[self._chosen].title if self._chosen < len(entries) else ""

    @property
    def places(self) -> dict[str, pygame.Rect]:
        """The places of the entries that can be chosen, by their titles."""
        return {entry.title: place for _, entry, place in self._places if entry.act is not None}

    def open(
        self,
        name: str,
        entries: Callable[[], Sequence[Entry]],
        corner: tuple[int, int],
        *,
        stays: bool = False,
    ) -> None:
        """Open it at a pixel; entries: returns those of now. stays: until an entry is chosen."""
        self.name, self._entries, self.corner, self._stays = name, entries, corner, stays
        self._typed, self._first, self._chosen = "", 0, -1
        self._move(1)

    def close(self) -> None:
        """Close it."""
        self.name, self._entries, self._places = "", None, []
        self.plate = pygame.Rect(0, 0, 0, 0)

    def _listed(self) -> Sequence[Entry]:
        return () if self._entries is None else self._entries()

    # -- events ---------------------------------------------------------------------------------

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event; return whether the menu took it."""
        if not self.is_open:
            return False
        if event.type == pygame.KEYDOWN:
            return self._press(event)
        if event.type == pygame.MOUSEMOTION:
            under = self._at(event.pos)
            self._chosen = self._chosen if under is None else under
            return bool(self.plate.collidepoint(event.pos))
        if event.type == pygame.MOUSEWHEEL:
            self._move(-event.y)
            return True
        if event.type != pygame.MOUSEBUTTONDOWN:
            return False
        if not self.plate.collidepoint(event.pos):
            if not self._stays:
                self.close()
            return False
        under = self._at(event.pos)
        if under is not None:
            self._choose(self._listed()[under])
        return True

    def _at(self, pixel: tuple[int, int]) -> int | None:
        """Return the number of the entry at a pixel that can be chosen, if there is one."""
        under = (k for k, entry, place in self._places if entry.act and place.collidepoint(pixel))
        return next(under, None)

    def _choose(self, entry: Entry) -> None:
        if entry.on is None:
            self.close()
        if entry.act is not None:
            entry.act()

    def _press(self, event: pygame.Event) -> bool:
        """Move, choose or close by a key; return whether it is no command for others."""
        name, entries = pygame.key.name(event.key), self._listed()
        moves = {"up": -1, "down": 1, "tab": 1, "page up": -8, "page down": 8}
        if name in MODIFIERS:
            return False
        named = label_of(event)
        by_key = next((entry for entry in entries if entry.act and entry.key == named), None)
        if by_key is not None:
            self._choose(by_key)
        elif name in moves:
            self._move(moves[name])
        elif name in ("home", "end"):
            self._chosen = -1 if name == "home" else len(entries)
            self._move(1 if name == "home" else -1)
        elif name in ("return", "enter", *(() if self._stays else ("space",))):
            self._choose(entries[self._chosen])
        elif name == "escape" or event.mod & CONTROL or (name[0] == "f" and name[1:].isdigit()):
            if not self._stays:
                self.close()
            return name == "escape" and not self._stays
        else:
            found = self._type(event.unicode.lower(), entries)
            return found or not self._stays or name in ("left", "right")
        return True

    def _move(self, by: int) -> None:
        """Choose an entry further down, or for numbers below 0 up; from the last, the first."""
        able = [k for k, entry in enumerate(self._listed()) if entry.act is not None]
        if not able or not by:
            return
        self._typed = ""
        way = 1 if by > 0 else -1
        ahead = sorted((k for k in able if way * (k - self._chosen) > 0), key=lambda k: way * k)
        self._chosen = ahead[min(abs(by), len(ahead)) - 1] if ahead else able[0 if by > 0 else -1]

    def _type(self, letter: str, entries: Sequence[Entry]) -> bool:
        """Choose the next entry that begins with the letters typed so far, or with this one.

        Return whether there is one.
        """
        if not letter.isprintable() or not letter:
            return False
        order = [*range(self._chosen, len(entries)), *range(max(self._chosen, 0))]
        longer = self._typed + letter
        for typed, numbers in ((longer, order), (letter, [*order[1:], *order[:1]])):
            found = (k for k in numbers if k >= 0 and entries[k].act is not None
                     and entries[k].title.lower().startswith(typed))  # fmt: skip
            k = next(found, None)
            if k is not None:
                self._chosen, self._typed = k, typed
                return True
        return False

    # -- drawing --------------------------------------------------------------------------------

    def size(self, painter: Painter) -> tuple[int, int]:
        """Return its width and height where there is room for all, pixels."""
        entries, ui, pad = self._listed(), painter.ui, round(PAD * painter.ui)
        width, fonts = painter.fonts.width, painter.fonts
        titles = max(
            max(width(each.title, SIZE * ui, bold=each.act is None),
                fonts.width(each.more, SMALL * ui)) + self._boxes(each, entries, ui)
            for each in entries
        )  # fmt: skip
        ends = max(width(f"{each.value}{each.key}", SIZE * ui) for each in entries)
        return (
            titles + (ends + round(24 * ui) if ends else 0) + 4 * pad,
            sum(_height(each, ui) for each in entries) + 2 * pad,
        )

    @staticmethod
    def _boxes(entry: Entry, entries: Sequence[Entry], ui: float) -> int:
        """Return the room before a title, for a tick box or dots, pixels."""
        most = max(max(len(each.colors), each.on is not None) for each in entries)
        return round(most * (BOX + 9) * ui) if entry.act is not None or entry.colors else 0

    def draw(self, surface: pygame.Surface, bounds: pygame.Rect, painter: Painter) -> None:
        """Draw it within bounds, if it is open; where there is no room for all, a part of it."""
        if self._entries is None:
            return
        entries, theme, ui = self._entries(), painter.theme, painter.ui
        self._arrange(entries, bounds, painter)
        painter.panel(surface, self.plate, theme.plate, 8 * ui, theme.key_edge)
        for k, entry, place in self._places:
            if entry.act is not None and k == self._chosen:
                painter.panel(surface, place, theme.key, 5 * ui, theme.selected)
            self._draw_entry(surface, entry, place, painter, self._boxes(entry, entries, ui))
        (first, *_), (last, *_) = self._places[0], self._places[-1]
        signs = (("▴", first > 0, "midtop"), ("▾", last + 1 < len(entries), "midbottom"))
        for sign, there, side in signs:
            if there:
                at = {side: getattr(self.plate, side)}
                painter.write(surface, sign, 12 * ui, theme.muted, **at)

    def _arrange(self, entries: Sequence[Entry], bounds: pygame.Rect, painter: Painter) -> None:
        """Place the plate and the entries that are seen, the chosen one among them."""
        ui, pad = painter.ui, round(PAD * painter.ui)
        heights = [_height(entry, ui) for entry in entries]
        width, height = self.size(painter)
        room = min(height, bounds.height) - 2 * pad
        self._chosen = min(self._chosen, len(entries) - 1)
        first = min(self._first, len(entries) - 1)
        if 0 <= self._chosen < first:
            first = self._chosen
        while first < self._chosen and sum(heights[first : self._chosen + 1]) > room:
            first += 1
        while first > 0 and sum(heights[first - 1 :]) <= room:
            first -= 1
        self._first = first
        seen = first + 1
        while seen < len(entries) and sum(heights[first : seen + 1]) <= room:
            seen += 1
        self.plate = pygame.Rect(self.corner, (width, sum(heights[first:seen]) + 2 * pad))
        self.plate.width = min(width, bounds.width)
        self.plate.clamp_ip(bounds)
        top, self._places = self.plate.top + pad, []
        for k in range(first, seen):
            place = pygame.Rect(self.plate.left + pad, top, self.plate.width - 2 * pad, heights[k])
            self._places.append((k, entries[k], place))
            top += heights[k]

    @staticmethod
    def _draw_entry(
        surface: pygame.Surface, entry: Entry, place: pygame.Rect, painter: Painter, boxes: int
    ) -> None:
        ui, fonts, theme = painter.ui, painter.fonts, painter.theme
        pad, side, title = round(PAD * ui), round(BOX * ui), entry.act is None
        left, middle = place.left + pad, place.top + round(ROW / 2 * ui)
        box = pygame.Rect(left, middle - side // 2, side, side)
        if entry.on is not None:
            fill, edge = (theme.selected,) * 2 if entry.on else (theme.plate, theme.muted)
            painter.panel(surface, box, fill, 3 * ui, edge)
        if entry.on:
            tick = [(box.left + x * side, box.top + y * side) for x, y in TICK]
            thick = max(2, round(2 * ui))
            pygame.draw.lines(surface, theme.plate, closed=False, points=tick, width=thick)
        for k, color in enumerate(entry.colors):
            dot = box.move(round(k * (BOX + 4) * ui), 0)
            painter.panel(surface, dot, theme.shade(color), side / 2)
        color = theme.muted if title else theme.ink
        size, right = SIZE * ui, (place.right - pad, middle)
        end = f"{entry.value}{entry.key}"
        room = painter.write(surface, end, size, theme.muted, midright=right).left - left - boxes
        text = fonts.shorten(entry.title, size, room, bold=title)
        painter.write(surface, text, size, color, bold=title, midleft=(left + boxes, middle))
        if entry.more:
            more = fonts.shorten(entry.more, SMALL * ui, place.right - pad - left - boxes)
            below = (left + boxes, middle + MORE * ui)
            painter.write(surface, more, SMALL * ui, theme.muted, midleft=below)


def _height(entry: Entry, ui: float) -> int:
    return round((ROW + (MORE if entry.more else 0.0)) * ui)
