"""Menus over the picture or beside it: of layers, of actions on a body, of properties."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from typing import NamedTuple

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.actions import CONTROL, MODIFIERS, label_of
from mars2d.window.widgets.help import draw_veil
from mars2d.window.widgets.rows import Pixel, Scroll, Word, write_line
from mars2d.window.widgets.text_field import TextField

ROW, MORE, PAD, BOX = 30.0, 18.0, 8.0, 15.0
"""The heights of an entry and of a line below it, the margin, a tick box's side, points."""
SIZE, SMALL = 14.5, 12.5
"""The heights of letters of an entry and of the line below it, points."""
SCALE, LEAST = 0.9, 220.0
"""How large a docked menu is, beside others, and the width below which it gets smaller, points."""
NOTCH = 40.0
"""How far a notch of the wheel scrolls, pixels."""
CHOSEN = "✓"
"""The value that marks the entry of what holds now, which is chosen when a menu opens."""
TICK = [(0.22, 0.52), (0.42, 0.74), (0.80, 0.26)]
FIELD = 320.0
"""The room for a field to type in, points."""
ASKED = frozenset({
    pygame.KEYDOWN, pygame.TEXTINPUT, pygame.TEXTEDITING, pygame.MOUSEBUTTONDOWN,
    pygame.MOUSEWHEEL,
})  # fmt: skip
"""The events that a menu that asks keeps from all else."""


class Entry(NamedTuple):
    """An entry of a menu.

    act: its effect; None for a title. key: the label of a key that has the same effect. on: whether
    its tick box is ticked; None for none. colors: of dots before the title. value: what is written
    at its right. more: a line below it. level: how far the title is indented. tone: "note" for
    words that are no heading, "warning" for what stands out. field: to type in, beside the title.
    """

    title: str
    act: Callable[[], object] | None = None
    key: str = ""
    on: bool | None = None
    colors: Sequence[str] = ()
    value: str = ""
    more: str = ""
    level: int = 0
    tone: str = ""
    field: TextField | None = None

    @property
    def height(self) -> float:
        """Its height, points."""
        return ROW + MORE * bool(self.more)

    @property
    def before(self) -> float:
        """The room before its title, for a tick box or dots, or as it is indented, points."""
        return BOX * self.level + (BOX + 6) * max(len(self.colors), self.on is not None)


class Menu:
    """A list of entries on a plate, which takes all keys while it is open.

    Arrow keys and Enter choose, as do the mouse, the keys named beside the entries, and the first
    letters of a title. Esc, a click elsewhere, and commands with Ctrl or a function key close it.
    One with tick boxes stays open until then. One that asks stays until an entry is chosen, in the
    middle, and nothing else can be done. A docked one fills its bounds and never closes; it takes
    keys while it has the focus.

    name: of what is open, or "". corner: where it was opened, pixels. plate: where it was drawn.
    """

    def __init__(self, *, docked: bool = False) -> None:
        """Start closed."""
        self._entries: Callable[[], Sequence[Entry]] | None = None
        self._docked, self.focused = docked, not docked
        self.name, self.corner = "", (0, 0)
        self.plate = pygame.Rect(0, 0, 0, 0)
        self._places: list[tuple[int, Entry, pygame.Rect]] = []
        self._chosen, self._typed = 0, ""  # the number of an entry; letters typed so far
        self._scroll = Scroll()
        self._sought = False  # whether the chosen entry is to be brought into view
        self._stays = self._asks = self._pointed = False
        self._most = 0.0  # the most room before a title

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

    @property
    def below(self) -> tuple[int, int]:
        """The pixel below the chosen entry, for a menu that it opens."""
        shown = (place.bottomleft for k, _, place in self._places if k == self._chosen)
        return next(shown, self.plate.topleft)

    def open(
        self,
        name: str,
        entries: Callable[[], Sequence[Entry]],
        corner: Pixel,
        *,
        stays: bool = False,
        asks: bool = False,
    ) -> None:
        """Open it at a pixel; entries: returns those of now. stays: until an entry is chosen.

        asks: it stays, and takes all events of keys and buttons.
        """
        self.name, self._entries, self.corner = name, entries, corner
        self._stays, self._asks = stays or asks, asks
        now = (k for k, entry in enumerate(entries()) if entry.value == CHOSEN)
        self._typed, self._scroll, self._chosen = "", Scroll(), next(now, 0) - 1
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
        if not self._asks:
            return self._take(event)
        field = next((entry.field for entry in self._listed() if entry.field is not None), None)
        if field is None or not field.handle(event):
            self._take(event)
        return event.type in ASKED

    def _take(self, event: pygame.Event) -> bool:
        if event.type == pygame.KEYDOWN:
            return self.focused and self._press(event)
        if event.type == pygame.MOUSEMOTION:
            self._chosen = next((k for k, _ in self._under(event.pos)), self._chosen)
            self._pointed = bool(self.plate.collidepoint(event.pos))
            return self._pointed
        if event.type == pygame.MOUSEWHEEL:
            self._scroll.at, self._sought = self._scroll.at - event.y * NOTCH, False
            return True
        if event.type != pygame.MOUSEBUTTONDOWN:
            return False
        if not self.plate.collidepoint(event.pos):
            if not self._stays:
                self.close()
            return False
        for k, entry in self._under(event.pos):
            self._chosen = k
            self._choose(entry)
        return True

    def _under(self, pixel: Pixel) -> list[tuple[int, Entry]]:
        """Return the entry at a pixel that can be chosen, with its number, if there is one."""
        return [(k, entry) for k, entry, place in self._places
                if entry.act and place.collidepoint(pixel)]  # fmt: skip

    def _choose(self, entry: Entry) -> None:
        if entry.on is None and not self._docked:
            self.close()
        if entry.act is not None:
            entry.act()

    def _press(self, event: pygame.Event) -> bool:
        """Move, choose or close by a key; return whether it is no command for others."""
        name, entries = pygame.key.name(event.key), self._listed()
        self._chosen = min(self._chosen, len(entries) - 1)
        moves = {"up": -1, "down": 1, "tab": 1, "page up": -8, "page down": 8}
        moves |= {"home": -len(entries), "end": len(entries)}
        if name in MODIFIERS:
            return False
        named = label_of(event)
        by_key = next((entry for entry in entries if entry.act and entry.key == named), None)
        if by_key is not None:
            self._choose(by_key)
        elif name in moves:
            self._move(moves[name])
        elif name in ("return", "enter", *(() if self._stays or self._typed else ("space",))):
            self._choose(entries[self._chosen])
        elif name == "escape" and self._docked:
            self.focused = False
        elif name == "escape" or event.mod & CONTROL or (name[0] == "f" and name[1:].isdigit()):
            if not self._stays:
                self.close()
            return name == "escape" and not self._stays
        else:
            self._type(event.unicode.lower(), entries)
        return True

    def _move(self, by: int) -> None:
        """Choose an entry further down, or up for numbers below 0; from the last one, the first."""
        able = [k for k, entry in enumerate(self._listed()) if entry.act is not None]
        ahead = [k for k in able if (k - self._chosen) * by > 0]
        self._typed, self._sought = "", True
        if ahead:
            self._chosen = ahead[min(by, len(ahead)) - 1] if by > 0 else ahead[max(by, -len(ahead))]
        elif able and abs(by) == 1:
            self._chosen = able[0 if by > 0 else -1]

    def _type(self, letter: str, entries: Sequence[Entry]) -> None:
        """Choose the next entry that begins with the letters typed so far, or with this one."""
        typed = self._typed + letter if letter.isprintable() and letter else ""
        for start, begin in ((self._chosen, typed), (self._chosen + 1, typed[-1:])):
            found = [
                k for k, entry in enumerate(entries)
                if begin and entry.act is not None and entry.title.lower().startswith(begin)
            ]  # fmt: skip
            if found:
                self._chosen = min(found, key=lambda k: (k < start, k))
                self._typed, self._sought = begin, True
                return

    # -- drawing --------------------------------------------------------------------------------

    def size(self, painter: Painter) -> tuple[int, int]:
        """Return its width and height where there is room for all, pixels."""
        entries, ui, width = self._listed(), painter.ui, painter.fonts.width
        self._most = max(each.before for each in entries)
        field = round(FIELD * ui) * any(each.field is not None for each in entries)
        titles = [
            round(self._before(each) * ui)
            + max(width(each.title, SIZE * ui, bold=each.act is None), width(each.more, SMALL * ui))
            for each in entries
        ]
        ends = max(width(f"{each.value}{each.key}", SIZE * ui) for each in entries)
        ends += round(24 * ui) if ends else 0
        high = sum(round(each.height * ui) for each in entries)
        pad = round(PAD * ui)
        return max(titles) + max(ends, field) + 4 * pad, high + 2 * pad

    def _before(self, entry: Entry) -> float:
        """Return the room before a title, points: the same for all entries of a menu that opens."""
        return entry.before if self._docked or entry.act is None else self._most

    def draw(self, surface: pygame.Surface, bounds: pygame.Rect, painter: Painter) -> None:
        """Draw it within bounds, if it is open; where there is no room for all, a part of it."""
        if self._entries is None:
            return
        if self._docked:
            painter = copy(painter)
            painter.ui = min(SCALE * painter.ui, bounds.width / LEAST)
        theme, ui = painter.theme, painter.ui
        self._arrange(self._entries(), bounds, painter)
        if self._asks:
            draw_veil(surface, painter, bounds)
        if self._docked:
            surface.fill(theme.bar, bounds)
            surface.fill(theme.edge, (bounds.left, bounds.top, 1, bounds.height))
        else:
            painter.panel(surface, self.plate, theme.plate, 8 * ui, theme.key_edge)
        for k, entry, place in self._places:
            if entry.act is not None and k == self._chosen and (self.focused or self._pointed):
                edge = theme.selected if self.focused else theme.key_edge
                painter.panel(surface, place, theme.key, 5 * ui, edge)
            self._draw_entry(surface, painter, entry, place.inflate(-2 * round(PAD * ui), 0))
        self._scroll.draw_bar(surface, painter, self.plate.inflate(-4 * ui, -16 * ui))

    def _arrange(self, entries: Sequence[Entry], bounds: pygame.Rect, painter: Painter) -> None:
        """Place the plate and the entries that are seen, the chosen one among them if sought."""
        pad, heights = round(PAD * painter.ui), [round(e.height * painter.ui) for e in entries]
        width, height = bounds.size if self._docked else self.size(painter)
        size = min(width, bounds.width), min(height, bounds.height)
        self.plate = pygame.Rect(self.corner, size).clamp(bounds)
        if self._asks:
            self.plate.center = bounds.center
        self._chosen = min(self._chosen, len(entries) - 1)
        sought = max(self._chosen, 0) if self._sought else None
        seen = self._scroll.seen(heights, self.plate.inflate(-2 * pad, -2 * pad), sought)
        self._places = [(k, entries[k], place) for k, place in seen]
        able = [k for k, entry, _ in self._places if entry.act is not None]
        self._chosen = min(able, key=lambda k: abs(k - self._chosen), default=self._chosen)

    def _draw_entry(
        self, surface: pygame.Surface, painter: Painter, entry: Entry, place: pygame.Rect
    ) -> None:
        theme, ui, side = painter.theme, painter.ui, round(BOX * painter.ui)
        middle, left = place.top + round(ROW / 2 * ui), place.left + round(self._before(entry) * ui)
        box = pygame.Rect(place.left, middle - side // 2, side, side)
        if entry.on is not None:
            fill, edge = (theme.selected,) * 2 if entry.on else (theme.plate, theme.muted)
            painter.panel(surface, box, fill, 3 * ui, edge)
        if entry.on:
            tick = [(box.left + x * side, box.top + y * side) for x, y in TICK]
            thick = max(2, round(2 * ui))
            pygame.draw.lines(surface, theme.plate, closed=False, points=tick, width=thick)
        for k, color in enumerate(entry.colors):
            painter.panel(
                surface, box.move(round(k * (BOX + 4) * ui), 0), theme.shade(color), side / 2
            )
        line = pygame.Rect(left, place.top, place.right - left, round(ROW * ui))
        head, size = entry.act is None and not entry.tone, SIZE * ui
        title, value = (theme.muted, theme.ink) if self._docked else (theme.ink, theme.muted)
        inks = {"note": theme.muted, "warning": theme.waiting.ink, "": value if head else title}
        room = line.width - round(PAD * ui) - painter.fonts.width(entry.title, size, bold=head)
        words = f"{entry.value}{entry.key}"
        words = painter.fonts.shorten(words, size, max(0.6 * line.width, room))
        titles = [Word(entry.title, inks[entry.tone], SIZE, head)]
        free = write_line(surface, line, painter, titles, [Word(words, value, SIZE)] * bool(words))
        if entry.field is not None:
            painter.panel(surface, free, theme.paper, 5 * ui, theme.selected)
            entry.field.draw(surface, free.inflate(-2 * round(PAD * ui), 0), painter, size)
        if entry.more:
            below = line.move(0, round(MORE * ui))
            write_line(surface, below, painter, [Word(entry.more, theme.muted, SMALL)])
