"""The buttons of the run window: of time, beside the time bar, and of all else, at the left."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import pygame

from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.window.run.keys import bound
from mars2d.window.widgets.buttons import Buttons
from mars2d.window.widgets.menu import Entry, Menu

Actions = Mapping[str, Callable[[], None]]
Pixel = tuple[int, int]

TRANSPORT = (("start", "back", "pause", "step", "newest"),)
SEE = ("layers", "scopes", "fit", "follow", "contacts", "predictions", "lesson")
CHANGE = ("parameters", "drive", "edit", "restart", "branch")
SAVE = ("picture", "film")
LOOK = ("screen", "dark", "text", "help", "leave")


class Toolbar:
    """All buttons of the window, and its menu.

    live: whether the run can be changed; a recording can't. lit: whether what a button switches is
    on.
    """

    def __init__(
        self, actions: Actions, lit: Callable[[str], bool], menu: Menu, *, live: bool
    ) -> None:
        """Start with nothing drawn."""
        offered = [SEE, CHANGE if live else (), SAVE, LOOK]
        groups = [[name for name in group if name in actions] for group in offered]
        self.bars = [
            Buttons([bound(group, actions, lit) for group in some if group])
            for some in (TRANSPORT, groups)
        ]
        self.menu = menu

    @property
    def places(self) -> dict[str, pygame.Rect]:
        """The places of all buttons, by the names of their actions."""
        return {name: place for bar in self.bars for name, place in bar.places.items()}

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event; return whether a button or the menu took it."""
        if self.menu.is_open and event.type == pygame.MOUSEBUTTONDOWN:
            opener = next((bar.at(event.pos) for bar in self.bars if bar.at(event.pos)), None)
            if opener is not None and opener == self.menu.name:
                self.menu.close()
                return True
        return self.menu.handle(event) or any(bar.handle(event) for bar in self.bars)

    def open(self, name: str, entries: Callable[[], Sequence[Entry]]) -> None:
        """Open a menu beside its button, or close it if it is open."""
        if self.menu.name == name:
            self.menu.close()
        else:
            place = self.places[name]
            self.menu.open(name, entries, (place.right + place.width // 5, place.top))

    def covers(self, pixel: Pixel) -> bool:
        """Return whether a menu covers a pixel."""
        return bool(self.menu.plate.collidepoint(pixel))

    def draw(
        self, surface: pygame.Surface, layout: Layout, painter: Painter, pointer: Pixel | None
    ) -> None:
        """Draw the buttons, the menu, and what the button under the pointer is for."""
        theme, edge = painter.theme, max(1, round(painter.ui))
        for area in (layout.transport, layout.tools):
            surface.fill(theme.bar, area)
        tools, transport = layout.tools, layout.transport
        surface.fill(theme.edge, (tools.right - edge, tools.top, edge, tools.height))
        surface.fill(theme.edge, (transport.left, transport.top, transport.width, edge))
        for bar, area in zip(self.bars, (transport, tools), strict=True):
            bar.draw(surface, area, painter, pointer)
        self.menu.draw(surface, layout.plot, painter)
        for bar in () if self.menu.is_open else self.bars:
            bar.draw_tip(surface, painter, pointer)
