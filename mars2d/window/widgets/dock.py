"""The dock: panels beside the arena, such as the inspector and plots, and where each stands."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import pygame

from mars2d.output.controls import CONTROLS
from mars2d.output.raster.layout import Bounds, Layout, fitted
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.buttons import draw_icon
from mars2d.window.widgets.panel import Frame, Panel
from mars2d.window.widgets.rows import Pixel, write_line

WIDTH, MIN_WIDTH = 344.0, 210.0
"""The width of a column, and the least width if the picture has it, points."""
MAX_SHARE = 0.46
"""The largest share of the picture's width for a wider column, and of its height for a strip."""
MARGIN, PAD, HEAD = 12.0, 14.0, 34.0
"""The gap round a panel, the margin in it, and the height of its title, points."""
CLOSE = 26.0
"""The side of the close button, in the upper right corner of a panel, points."""
BESIDE = 0.5
"""The smallest scale of the arena beside panels, in parts of that without any; where it would be
smaller, panels cover a part of the picture."""
NEAR = 30.0
"""How far panels that cover a part of the picture stay from the selected body, points."""
MOUSE = (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP, pygame.MOUSEMOTION, pygame.MOUSEWHEEL)


class Place(NamedTuple):
    """Where panels may stand: lanes, in each of which they lie one below the other, in pixels.

    room: the part of the picture that is left for the arena.
    """

    room: pygame.Rect
    lanes: Sequence[pygame.Rect]


class Dock:
    """The panels of a window, of which the open ones stand beside the arena, in their order.

    They stand in a column at the right, in several, or in a strip below, wherever the arena stays
    largest and the panels have room. Only where the arena would get too small do they cover a part
    of it, away from what is selected. Where there is no room for all, those opened last are seen
    whole, and of the others only the titles, which open them.

    plates: where open panels were drawn, by name. closes: where their close buttons were drawn.
    """

    def __init__(self, painter: Painter, panels: Sequence[Panel]) -> None:
        """Start with nothing drawn."""
        self.painter, self.panels = painter, panels
        self.plates: dict[str, pygame.Rect] = {}
        self.closes: dict[str, pygame.Rect] = {}
        self._folded: set[str] = set()
        self._recent: list[str] = []  # names, the one opened last first
        self._place: Place | None = None
        self._plot = self._room = pygame.Rect(0, 0, 0, 0)
        self._chosen: object = None  # what the place was chosen for
        self._framed: object = None  # what the room was made for
        self._mirrored = False
        self._held: Panel | None = None
        self._frame: Frame = None
        self._sizes: dict[tuple[str, int], tuple[float, float]] = {}  # in this picture

    @property
    def opened(self) -> list[str]:
        """The names of the open panels that are remembered."""
        return [panel.name for panel in self.panels if panel.wanted and panel.remembered]

    @property
    def free(self) -> list[pygame.Rect]:
        """The sides of the picture on which no panel was drawn, the largest first."""
        plot, plates = self._plot, list(self.plates.values())
        if not plates:
            return [plot]
        taken = plates[0].unionall(plates[1:])
        sides = (
            pygame.Rect(plot.topleft, (taken.left - plot.left, plot.height)),
            pygame.Rect(taken.right, plot.top, plot.right - taken.right, plot.height),
            pygame.Rect(plot.topleft, (plot.width, taken.top - plot.top)),
            pygame.Rect(plot.left, taken.bottom, plot.width, plot.bottom - taken.bottom),
        )
        there = [side for side in sides if min(side.size) > 0]
        return sorted(there, key=lambda side: -side.width * side.height)

    @property
    def beside(self) -> bool:
        """Whether all panels stand beside the arena, whose room is where it would be anew."""
        return self._place is None or self._place.room == self._room

    def named(self, name: str) -> Panel:
        """Return the panel of a name."""
        return next(panel for panel in self.panels if panel.name == name)

    def open(self, names: Iterable[str]) -> None:
        """Open the panels of these names; unknown names are left out."""
        for panel in self.panels:
            if panel.remembered and panel.name in names:
                panel.open()

    def switch(self, name: str) -> None:
        """Open a panel, bring it to sight if it is folded, or close it."""
        panel = self.named(name)
        if not panel.is_open:
            panel.open()
        elif name in self._folded:
            self._bring(name)
        else:
            panel.close()

    def covers(self, pixel: Pixel) -> bool:
        """Return whether a panel was drawn at a pixel."""
        return self._at(pixel) is not None

    def _at(self, pixel: Pixel) -> str | None:
        return next((name for name, at in self.plates.items() if at.collidepoint(pixel)), None)

    def reframe(self) -> None:
        """Let the arena move aside for all open panels, when they are arranged next."""
        self._framed = None

    def _bring(self, name: str) -> None:
        """Let a panel have room before all others."""
        self._recent.remove(name)
        self._recent.insert(0, name)

    # -- places -------------------------------------------------------------------------------

    @property
    def _shown(self) -> list[Panel]:
        return [panel for panel in self.panels if panel.is_open]

    def arrange(self, layout: Layout, frame: Frame, bounds: Bounds) -> pygame.Rect:
        """Choose where the open panels stand; return the part of the picture for the arena.

        It stays where it is when a panel opens that does not frame, such as for what is selected.
        bounds: of the arena, metres.
        """
        self._plot, shown, self._frame, self._sizes = layout.plot, self._shown, frame, {}
        names = [panel.name for panel in shown]
        new = [name for name in names if name not in self._recent]
        self._recent = [*reversed(new), *(name for name in self._recent if name in names)]
        framed = layout, *(panel.name for panel in shown if panel.frames)
        anew, first = framed != self._framed, self._framed is None
        chosen = [(panel.name, panel.wanted) for panel in shown]
        if anew or chosen != self._chosen:  # not where only heights change
            self._chosen = chosen
            self._place = self._best(layout, bounds, anew=anew) if shown else None
        if self.plates.keys() != set(names):  # what covers the picture, before it is drawn
            self.plates = self._plates()
        if anew:
            moves = first or len(framed) > 1
            room = self._place.room if self._place is not None and moves else self._plot
            self._framed, self._room = framed, room
        return self._room

    def _best(self, layout: Layout, bounds: Bounds, *, anew: bool) -> Place | None:
        """Return the place at which arena and panels are largest, if there is one.

        anew: whether the arena may move; else places beside where it is come first.
        """

        def scale(plot: pygame.Rect) -> float:
            return fitted(bounds, layout.size, replace(layout, plot=plot)).scale

        def worth(place: Place) -> tuple[bool, float]:
            """Return whether all panels have room, and how large arena and panels are."""
            wanted = sum(self._heights(panel, place.lanes[0])[1] for panel in self._shown)
            room = min(sum(lane.height for lane in place.lanes) / wanted, 1.0)
            whole = self._stacks(place.lanes, self._recent)
            return whole is not None, min(scale(place.room) / alone, 1.0) * room**0.5

        alone = scale(self._plot)
        arena = round((bounds[3] - bounds[2]) * alone + 56 * self.painter.ui)
        places = list(self._places(arena))
        beside = [place for place in places if scale(place.room) >= BESIDE * alone]
        beside = [place for place in beside if not anew and place.room == self._room] or beside
        covering = [place._replace(room=self._plot) for place in places[:1]]
        return max(beside or covering, key=worth, default=None)

    def _places(self, arena: int) -> Iterator[Place]:
        """Yield the places for the open panels: columns at the right, and a strip below.

        arena: how high it is where there are no panels, pixels.
        """
        ui, plot, gap = self.painter.ui, self._plot, round(MARGIN * self.painter.ui)
        shown, width = self._shown, max(MAX_SHARE * plot.width, MIN_WIDTH * ui)
        width = round(min(WIDTH * ui, width, plot.width - 2 * gap))

        def lanes(area: pygame.Rect, count: int) -> list[pygame.Rect]:
            wide, high = (area.width - gap) // count - gap, area.height - 2 * gap
            lefts = (area.left + gap + k * (wide + gap) for k in range(count))
            return [pygame.Rect(left, area.top + gap, wide, high) for left in lefts]

        for count in range(1, len(shown) + 1):
            beside = count * (width + gap) + gap
            if beside >= plot.width:
                break
            room = pygame.Rect(plot.topleft, (plot.width - beside, plot.height))
            area = pygame.Rect(room.topright, (beside, plot.height))
            yield Place(room, lanes(area, count))
        count = max(1, min(len(shown), (plot.width - gap) // round(WIDTH * ui + gap)))
        lane = lanes(plot, count)[0]
        least, most = (max(self._heights(panel, lane)[k] for panel in shown) for k in (0, 1))
        free = plot.height - arena - 2 * gap  # below the arena
        below = round(min(max(least, free), most, MAX_SHARE * plot.height)) + 2 * gap
        room = pygame.Rect(plot.topleft, (plot.width, plot.height - below))
        yield Place(room, lanes(pygame.Rect(room.bottomleft, (plot.width, below)), count))

    def _heights(self, panel: Panel, lane: pygame.Rect) -> tuple[float, float]:
        """Return the least and the wanted height of a whole panel in a lane, pixels."""
        ui, of = self.painter.ui, (panel.name, lane.width)
        if of not in self._sizes:
            self._sizes[of] = panel.heights(self._frame, lane.width / ui - 2 * PAD)
        least, wanted = self._sizes[of]
        return min((least + PAD + HEAD) * ui, lane.height), (wanted + PAD + HEAD) * ui

    def _plates(self) -> dict[str, pygame.Rect]:
        """Return where panels stand, by name; sets which are not seen whole.

        Where there is no room for all, those opened longest ago are folded, then left out; that
        opened last is always seen whole.
        """
        if self._place is None:
            return {}
        lanes, recent = self._place.lanes, self._recent
        tries = [(recent[:k], recent[k:]) for k in range(len(recent), 0, -1)]
        tries += [(recent[:1], recent[1:k]) for k in range(len(recent) - 1, 0, -1)]
        made = ((self._stacks(lanes, *names), names[0]) for names in tries)
        stacks, whole = next((stacks, whole) for stacks, whole in made if stacks is not None)
        self._folded = {*recent} - {*whole}
        gap, found = round(MARGIN * self.painter.ui), {}
        for lane, stack in zip(lanes, stacks, strict=True):
            more = sum(wanted - least for _, least, wanted in stack)
            rest = lane.height - gap * (len(stack) - 1) - sum(least for _, least, _ in stack)
            share, top = min(1.0, rest / more) if more else 0.0, lane.top
            for name, least, wanted in stack:
                height = int(least + share * (wanted - least))
                found[name] = pygame.Rect(lane.left, top, lane.width, height)
                top += height + gap
        return found

    def _stacks(
        self, lanes: Sequence[pygame.Rect], whole: Sequence[str], folded: Sequence[str] = ()
    ) -> list[list[tuple[str, float, float]]] | None:
        """Return the panels of each lane with their least and wanted heights; None for no room.

        Each is put where most room is left. whole, folded: the names of panels to be seen.
        """
        gap, head = round(MARGIN * self.painter.ui), HEAD * self.painter.ui
        stacks: list[list[tuple[str, float, float]]] = [[] for _ in lanes]
        rooms = [lane.height + gap for lane in lanes]
        for panel in self._shown:
            k, least, wanted = rooms.index(max(rooms)), head, head
            if panel.name in whole:
                least, wanted = self._heights(panel, lanes[k])
            if panel.name in (*whole, *folded):
                rooms[k] -= round(least) + gap
                stacks[k].append((panel.name, least, max(least, wanted)))
        return stacks if min(rooms) >= 0 else None

    def _aside(self, spot: tuple[float, float] | None) -> tuple[int, int]:
        """Return by how much all panels are moved, so that they do not cover a spot, pixels."""
        if spot is None or self._place is None:
            self._mirrored = False
            return 0, 0
        first, plot = self._place.lanes[0].unionall(list(self._place.lanes[1:])), self._plot
        across, down = (2 * (a - b) for a, b in zip(plot.center, first.center, strict=True))
        column = first.width < plot.width // 2  # at the right, which goes to the left
        away = (across, 0) if column else (0, down)
        near = round(2 * NEAR * self.painter.ui)
        covered = [
            each.inflate(near, near).collidepoint(spot) for each in (first, first.move(away))
        ]
        if covered[self._mirrored] and not covered[not self._mirrored]:
            self._mirrored = not self._mirrored
        return away if self._mirrored else (0, 0)

    # -- drawing and the mouse ----------------------------------------------------------------

    def draw(
        self,
        surface: pygame.Surface,
        frame: Frame,
        spot: tuple[float, float] | None = None,
        pointer: Pixel | None = None,
        *,
        free: pygame.Rect | None = None,
    ) -> None:
        """Draw the open panels where `arrange` has put them.

        spot: a pixel that they should not cover, where they have no room beside the arena. free:
        where nothing may be covered; panels that would are left out. pointer: where the mouse is.
        """
        self._frame, self._sizes = frame, {}
        away, plates = self._aside(spot), self._plates()
        self.plates, self.closes = {}, {}
        for panel in self._shown:
            plate = plates.get(panel.name, pygame.Rect(0, 0, 0, 0)).move(away)
            if plate and not (free is not None and plate.colliderect(free)):
                self.plates[panel.name] = plate
                self._draw_panel(surface, panel, pointer)

    def _draw_panel(self, surface: pygame.Surface, panel: Panel, pointer: Pixel | None) -> None:
        """Draw a panel with its title and its close button."""
        ui, theme, plate = self.painter.ui, self.painter.theme, self.plates[panel.name]
        pad, side = round(PAD * ui), round(CLOSE * ui)
        self.painter.panel(surface, plate, theme.plate, 8 * ui, theme.edge)
        top = pygame.Rect(
            plate.left + pad, plate.top, plate.width - 2 * pad - side, round(HEAD * ui)
        )
        write_line(surface, top, self.painter, *panel.head(self._frame))
        if panel.name not in self._folded:
            inside = plate.inflate(-2 * pad, 0)
            inside.top, inside.height = top.bottom, plate.bottom - top.bottom - pad // 2
            panel.draw(surface, inside, self._frame)
        close = pygame.Rect(0, 0, side, side)
        close.midright = plate.right - pad // 2, top.centery
        over = pointer is not None and close.collidepoint(pointer)
        draw_icon(surface, CONTROLS["close"].icon, theme.ink if over else theme.muted, close)
        self.closes[panel.name] = close

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event of the mouse; return whether a panel took it."""
        if event.type not in MOUSE:
            return False
        if self._held is not None and event.type != pygame.MOUSEBUTTONDOWN:
            self._held.handle(event)
            if event.type == pygame.MOUSEBUTTONUP:
                self._held = None
            return True
        name = self._at(pygame.mouse.get_pos() if event.type == pygame.MOUSEWHEEL else event.pos)
        if name is None:
            return False
        panel = self.named(name)
        left = event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT
        if left and self.closes[name].collidepoint(event.pos):
            panel.close()
        elif name in self._folded:
            if left:
                self._bring(name)
        elif panel.handle(event):
            self._held = panel
        return event.type in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEWHEEL)
