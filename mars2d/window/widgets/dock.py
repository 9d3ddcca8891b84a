"""The dock: panels beside the arena, such as the inspector and plots, and where each stands."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import pygame

from mars2d.output.controls import CONTROLS
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.window.widgets.buttons import draw_icon

Pixel = tuple[int, int]
Frame = Any
"""What panels show: the dock passes it on."""

WIDTH, MIN_WIDTH = 344.0, 210.0
"""The width of a column, points, and the width below which nothing is drawn."""
MAX_SHARE = 0.46
"""The largest share of the picture's width for a column, and of its height for a strip."""
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


class Panel:
    """A panel of the dock: a plate with a title and a close button, and content of its own.

    To add one, derive a class that sets `name` and `title` and has `heights` and `draw` (and
    `handle`, if its content can be clicked or dragged), and put it into the list of panels in
    `window.py`. The dock does the rest: it finds a place, draws plate, title and close button,
    passes the mouse on, and remembers from one window to the next which panels were open.

    name: one word, by which the panel is opened and remembered. title: written at its top, and all
    that is seen of it where there is no room. headed: whether the dock writes the title; else the
    panel draws a head of its own, and leaves the corner at the upper right to the close button.
    frames: whether the arena moves aside when it opens or changes its size. wanted: whether it is
    to be open, or with how many plots, which need room. remembered: whether the next window opens
    it again. pointer: where the mouse is, if it is over the panel, before each drawing.
    """

    name = ""
    title = ""
    headed = True
    frames = True
    remembered = True
    wanted: int = False
    pointer: Pixel | None = None

    @property
    def offered(self) -> bool:
        """Whether there is anything to show."""
        return True

    @property
    def is_open(self) -> bool:
        """Whether it is wanted, and there is something to show."""
        return bool(self.wanted and self.offered)

    def open(self) -> None:
        """Open it."""
        self.wanted = True

    def close(self) -> None:
        """Close it."""
        self.wanted = False

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the least and the wanted height of the content at a width, points.

        The least height may depend only on what the user has chosen, not on what happens in the
        run: else the arena would change its size while it is watched.
        """
        raise NotImplementedError

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:
        """Draw the content within a rectangle, which is at least as high as the least height.

        It is called for each picture, 60 times a second: what is costly should be kept.
        """
        raise NotImplementedError

    def handle(self, event: pygame.Event) -> bool:  # noqa: ARG002
        """Handle an event of the mouse within the panel; return whether a drag has begun.

        Presses and turns of the wheel are those within the panel, positions are pixels of the
        window. After a press that returned True, all moves of the mouse come here, until the
        button is released; else only those over the panel do.
        """
        return False


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
        self._chosen: list[tuple[str, int]] = []  # panels for which the place is
        self._recent: list[str] = []  # names, the one opened last first
        self._place: Place | None = None
        self._plot = self._room = pygame.Rect(0, 0, 0, 0)
        self._framed: tuple[object, ...] | None = None  # the panels for which the room was made
        self._mirrored = False
        self._held: Panel | None = None

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

    def open(self, names: Iterable[str]) -> None:
        """Open the panels of these names; unknown names are left out."""
        for panel in self.panels:
            if panel.remembered and panel.name in names:
                panel.open()

    def switch(self, name: str) -> None:
        """Open a panel, bring it to sight if it is folded, or close it."""
        panel = next(panel for panel in self.panels if panel.name == name)
        if not panel.is_open:
            panel.open()
        elif name in self._folded:
            self._bring(name)
        else:
            panel.close()

    def covers(self, pixel: Pixel) -> bool:
        """Return whether a panel was drawn at a pixel."""
        return any(plate.collidepoint(pixel) for plate in self.plates.values())

    # -- places -------------------------------------------------------------------------------

    def arrange(
        self, layout: Layout, frame: Frame, fit: Callable[[Layout], Camera], tall: float
    ) -> pygame.Rect:
        """Choose where the open panels stand; return the part of the picture for the arena.

        It stays where it is when a panel opens that does not frame, such as for what is selected.
        fit: returns the camera that shows all of an arena that is `tall` metres high.
        """
        self._plot, shown = layout.plot, self._shown
        names = [panel.name for panel in shown]
        new = [name for name in names if name not in self._recent]
        self._recent = [*reversed(new), *(name for name in self._recent if name in names)]
        framed = layout, *(panel.name for panel in shown if panel.frames)
        anew = framed != self._framed
        chosen = [(panel.name, panel.wanted) for panel in shown]
        if anew or chosen != self._chosen:  # not where only heights change
            self._chosen = chosen
            self._place = self._best(layout, frame, fit, tall, anew=anew) if shown else None
        place = self._place
        if self.plates.keys() != set(names):  # what covers the picture, before it is drawn
            self.plates = self._plates(place.lanes, frame) if place else {}
        if anew:
            moves = place is not None and (self._framed is None or len(framed) > 1)
            self._framed, self._room = framed, place.room if place and moves else self._plot
        return self._room

    @property
    def _shown(self) -> list[Panel]:
        return [panel for panel in self.panels if panel.is_open]

    @property
    def beside(self) -> bool:
        """Whether all panels stand beside the arena, whose room is where it would be anew."""
        return self._place is None or self._place.room == self._room

    def reframe(self) -> None:
        """Let the arena move aside for all open panels, when they are arranged next."""
        self._framed = None

    def _best(
        self, layout: Layout, frame: Frame, fit: Callable[[Layout], Camera], tall: float, *,
        anew: bool,
    ) -> Place | None:  # fmt: skip
        """Return the place at which arena and panels are largest, if there is one.

        anew: whether the arena may move; else places beside where it is come first.
        """
        shown = self._shown

        def scale(plot: pygame.Rect) -> float:
            return fit(replace(layout, plot=plot)).scale

        alone = scale(self._plot)

        def worth(place: Place) -> tuple[bool, float]:
            """Return whether all panels have room, and how large arena and panels are."""
            arena = min(scale(place.room) / alone, 1.0)
            wanted = sum(self._heights(panel, frame, place.lanes[0])[1] for panel in shown)
            room = min(sum(lane.height for lane in place.lanes) / wanted, 1.0)
            whole = dict.fromkeys(self._recent, 2)
            fits = self._stacks(place.lanes, whole, frame) is not None
            return fits, arena * room**0.5

        places = list(self._places(frame, round(tall * alone + 56 * self.painter.ui)))
        beside = [place for place in places if scale(place.room) >= BESIDE * alone]
        beside = [place for place in beside if not anew and place.room == self._room] or beside
        covering = [place._replace(room=self._plot) for place in places[:1]]
        return max(beside, key=worth) if beside else next(iter(covering), None)

    def _places(self, frame: Frame, arena: int) -> Iterator[Place]:
        """Yield the places for the open panels: columns at the right, and a strip below.

        arena: how high it is where there are no panels, pixels.
        """
        ui, plot, gap = self.painter.ui, self._plot, round(MARGIN * self.painter.ui)
        shown, width = self._shown, round(min(WIDTH * ui, MAX_SHARE * plot.width))
        if width < MIN_WIDTH * ui:
            return

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
        least, most = (max(self._heights(panel, frame, lane)[k] for panel in shown) for k in (0, 1))
        free = plot.height - arena - 2 * gap  # below the arena
        below = round(min(max(least, free), most, MAX_SHARE * plot.height)) + 2 * gap
        room = pygame.Rect(plot.topleft, (plot.width, plot.height - below))
        yield Place(room, lanes(pygame.Rect(room.bottomleft, (plot.width, below)), count))

    def _heights(self, panel: Panel, frame: Frame, lane: pygame.Rect) -> tuple[float, float]:
        """Return the least and the wanted height of a whole panel in a lane, pixels."""
        ui = self.painter.ui
        least, wanted = panel.heights(frame, lane.width / ui - 2 * PAD)
        more = PAD + (HEAD if panel.headed else 0)
        return min((least + more) * ui, lane.height), (wanted + more) * ui

    def _plates(self, lanes: Sequence[pygame.Rect], frame: Frame) -> dict[str, pygame.Rect]:
        """Return where panels stand in lanes, by name; sets which are not seen whole.

        Where there is no room for all, those opened longest ago are folded, then left out; that
        opened last is always seen whole.
        """
        levels = dict.fromkeys(reversed(self._recent), 2)  # 2: whole, 1: folded, 0: left out
        while (stacks := self._stacks(lanes, levels, frame)) is None:
            *others, _ = levels
            levels[max(others, key=levels.__getitem__)] -= 1
        self._folded = {name for name, level in levels.items() if level < 2}
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
        self, lanes: Sequence[pygame.Rect], levels: Mapping[str, int], frame: Frame
    ) -> list[list[tuple[str, float, float]]] | None:
        """Return the panels of each lane with their least and wanted heights; None for no room.

        Each is put where most room is left.
        """
        gap, head = round(MARGIN * self.painter.ui), HEAD * self.painter.ui
        stacks: list[list[tuple[str, float, float]]] = [[] for _ in lanes]
        rooms = [lane.height + gap for lane in lanes]
        for panel in self._shown:
            k, level = rooms.index(max(rooms)), levels[panel.name]
            least, wanted = self._heights(panel, frame, lanes[k]) if level > 1 else (head, head)
            if level:
                rooms[k] -= round(least) + gap
                stacks[k].append((panel.name, least, max(least, wanted)))
        return stacks if min(rooms) >= 0 else None

    def _aside(self, spot: tuple[float, float] | None) -> tuple[int, int]:
        """Return by how much all panels are moved, so that they do not cover a spot, pixels."""
        if spot is None or self._place is None:
            self._mirrored = False
            return 0, 0
        first, plot = self._place.lanes[0].unionall(list(self._place.lanes[1:])), self._plot
        if first.width < plot.width // 2:  # a column at the right, which goes to the left
            away = plot.left + plot.right - first.left - first.right, 0
        else:
            away = 0, plot.top + plot.bottom - first.top - first.bottom
        near = round(2 * NEAR * self.painter.ui)
        other = first.move(away)
        here, there = (other, first) if self._mirrored else (first, other)
        if here.inflate(near, near).collidepoint(spot):
            self._mirrored ^= not there.inflate(near, near).collidepoint(spot)
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
        ui, theme = self.painter.ui, self.painter.theme
        self.plates, self.closes = {}, {}
        away = self._aside(spot)
        plates = self._plates(self._place.lanes, frame) if self._place else {}
        for panel in (panel for panel in self._shown if panel.name in plates):
            plate = plates[panel.name].move(away)
            if free is not None and plate.colliderect(free):
                continue
            self.painter.panel(surface, plate, theme.plate, 8 * ui, theme.edge)
            pad, headed = round(PAD * ui), 0
            if panel.headed or panel.name in self._folded:
                self._draw_title(surface, plate, panel)
                headed = round(HEAD * ui)
            top = plate.top + (headed or round(PAD / 2 * ui))
            inside = pointer is not None and plate.collidepoint(pointer)
            panel.pointer = pointer if inside else None
            if panel.name not in self._folded:
                bottom = plate.bottom - round(PAD / 2 * ui)
                panel.draw(
                    surface,
                    pygame.Rect(plate.left + pad, top, plate.width - 2 * pad, bottom - top),
                    frame,
                )
            close = pygame.Rect(0, 0, round(CLOSE * ui), round(CLOSE * ui))
            close.midright = plate.right - pad // 2, top + round(HEAD / 2 * ui) - headed
            over = pointer is not None and close.collidepoint(pointer)
            draw_icon(surface, CONTROLS["close"].icon, theme.ink if over else theme.muted, close)
            self.plates[panel.name], self.closes[panel.name] = plate, close

    def _draw_title(self, surface: pygame.Surface, plate: pygame.Rect, panel: Panel) -> None:
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        room = plate.width - (2 * PAD + CLOSE) * ui
        word = fonts.shorten(panel.title, 13.5 * ui, room, bold=True)
        color = theme.muted if panel.name in self._folded else theme.ink
        middle = plate.left + PAD * ui, plate.top + HEAD / 2 * ui
        self.painter.write(surface, word, 13.5 * ui, color, bold=True, midleft=middle)

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event of the mouse; return whether a panel took it."""
        if event.type not in MOUSE:
            return False
        if self._held is not None and event.type != pygame.MOUSEBUTTONDOWN:
            held = self._held
            if event.type == pygame.MOUSEBUTTONUP:
                self._held = None
            held.handle(event)
            return True
        pixel = pygame.mouse.get_pos() if event.type == pygame.MOUSEWHEEL else event.pos
        name = next((n for n, plate in self.plates.items() if plate.collidepoint(pixel)), None)
        if name is None:
            return False
        panel = next(panel for panel in self.panels if panel.name == name)
        left = event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT
        if left and self.closes[name].collidepoint(pixel):
            panel.close()
        elif name in self._folded:
            if left:
                self._bring(name)
        elif panel.handle(event):
            self._held = panel
        return event.type in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEWHEEL)

    def _bring(self, name: str) -> None:
        """Let a panel have room before all others."""
        self._recent.remove(name)
        self._recent.insert(0, name)
