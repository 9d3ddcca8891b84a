"""The home: a window from which all else is one click away."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from math import inf
from pathlib import Path

import pygame

from mars2d.output.raster.layout import interface_scale
from mars2d.scenario.examples import GAME, courses, examples, games, thumbnail_of, title_of
from mars2d.window.run.keys import HOME, bound
from mars2d.window.screen.display import PICTURES_A_SECOND, started_display
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.memory import Memory
from mars2d.window.screen.rest import Rest
from mars2d.window.widgets.actions import action_of
from mars2d.window.widgets.buttons import Buttons
from mars2d.window.widgets.cards import NOTCH, Card, Page, Shelf
from mars2d.window.widgets.help import Help
from mars2d.window.widgets.notes import Notes
from mars2d.window.widgets.text_field import TextField

HEADER, FOOTER = 58.0, 44.0
"""The heights of the bars, points."""
OPENS = {".py": "run", ".toml": "run", ".npz": "replay", ".mcap": "replay"}
"""The command that opens a file, by its suffix."""
HINT, MORE = "Type to search", ", F1: all keys"


class Home:
    """Shows the examples, the games and the user's own files, until one is chosen.

    memory: of recent files and looks. note: what went wrong with the last choice, or "".
    """

    def __init__(self, memory: Memory, note: str = "") -> None:
        """Prepare; the window opens with `run`."""
        self._memory = memory
        self._notes, self._rest = Notes(), Rest()
        self.looks = Looks(memory.preferences(), self._notes.say)
        self.painter, self.size = self.looks.painter, memory.size
        self.page, self.search = Page(), TextField()
        self.choice: tuple[str, ...] | None = None
        self.help = Help()
        self._actions: dict[str, Callable[[], None]] = {
            "right": partial(self.page.move, 1, 0),
            "left": partial(self.page.move, -1, 0),
            "up": partial(self.page.move, 0, -1),
            "down": partial(self.page.move, 0, 1),
            "turn_back": partial(self.page.turn, -0.9),
            "turn_on": partial(self.page.turn, 0.9),
            "open": self._choose,
            "watch": self._watch,
            **self.looks.actions,
            "help": self.help.turn,
            "escape": self._escape,
            "leave": self._leave,
        }
        buttons = bound(("dark", "text"), self._actions, self.looks.is_on, HOME)
        self._buttons = Buttons([buttons])
        self._open = True
        if note:
            self._notes.say(note, "error")

    def run(self) -> tuple[str, ...] | None:
        """Return the arguments of the command that opens what was chosen; None to leave.

        Raises InputError without a display.
        """
        with started_display():
            pygame.display.set_caption("MARS2D")
            screen = pygame.display.get_surface() or self.looks.open(self.size)
            pygame.key.start_text_input()
            clock = pygame.time.Clock()
            while self._open:
                self.draw(pygame.display.get_surface() or screen)
                pygame.display.flip()
                clock.tick(PICTURES_A_SECOND)
                for event in self._rest.events():
                    self.handle(event)
            size = (pygame.display.get_surface() or screen).get_size()
        self._memory.keep(**self.looks.remembered(size))
        return self.choice

    @property
    def shelves(self) -> list[Shelf]:
        """The shelves, with the cards in which the words that were typed occur, titles first."""
        words, found = self.search.text, list[Shelf]()
        for shelf in self._all_shelves():
            cards = [card for card in shelf.cards if card.has(words)]
            cards.sort(key=lambda card: not card.is_called(words))
            found += [Shelf(shelf.title, cards)] if cards else []
        return sorted(found, key=lambda shelf: not shelf.cards[0].is_called(words))

    def _all_shelves(self) -> list[Shelf]:
        own = [_own_card(path, self._memory.picture(path)) for path in self._memory.recent]
        new = Card("New drawing", "Draw a scenario with the mouse.", ("edit",), sign="+")
        found, play = courses(), games()
        shelves = {"Play": play} | {
            course: [name for name in names if name not in play] for course, names in found.items()
        }
        return [
            Shelf("Your own", [new, *own]),
            *(
                Shelf(title, [self._example_card(name, plays=title == "Play") for name in names])
                for title, names in shelves.items()
            ),
        ]

    def _example_card(self, name: str, *, plays: bool) -> Card:
        looks = "dark" if self.painter.theme.dark else "light"
        watch, play = ("demo", name), ("play", name)
        others = {"Play": play, "Watch": watch} if plays else {}
        picture = thumbnail_of(name, looks)
        command = play if plays else watch
        return Card(*title_of(name), command, picture, words=_words_of(name), others=others)

    # -- drawing --------------------------------------------------------------------------------

    def draw(self, surface: pygame.Surface) -> None:
        """Draw the home on a surface of any size."""
        size, painter = surface.get_size(), self.painter
        ui = painter.ui = interface_scale(size, self.looks.text, self.looks.scale)
        theme, pad = painter.theme, round(30 * ui)
        header = pygame.Rect(0, 0, size[0], round(HEADER * ui))
        footer = pygame.Rect(0, 0, size[0], round(FOOTER * ui))
        footer.bottom = size[1]
        area = pygame.Rect(0, header.bottom, size[0], footer.top - header.bottom)
        self.page.arrange(self.shelves, area, ui)
        self.page.draw(surface, painter)
        for bar in (header, footer):
            surface.fill(theme.bar, bar)
        surface.fill(theme.edge, (0, header.bottom - 1, size[0], 1))
        surface.fill(theme.edge, (0, footer.top, size[0], 1))
        at = (pad, header.centery)
        painter.write(surface, "MARS2D", 22 * ui, theme.ink, bold=True, midleft=at)
        here = pygame.display.get_init() and pygame.mouse.get_focused()
        pointer = pygame.mouse.get_pos() if here else None
        buttons = pygame.Rect(0, 0, round(96 * ui), round(44 * ui))
        buttons.midright = size[0] - round(0.5 * pad), header.centery
        self._buttons.draw(surface, buttons, painter, pointer)
        self._draw_search(surface, header, buttons.left - pad // 2)
        self._draw_line(surface, footer, pad)
        self._notes.draw(surface, area, painter, pygame.time.get_ticks() / 1000)
        self._buttons.draw_tip(surface, painter, pointer)
        keys = [action for action in HOME if action.help]
        self.help.draw(surface, self.looks.layout(size), painter, [("Home", keys)])

    def _draw_search(self, surface: pygame.Surface, header: pygame.Rect, right: int) -> None:
        """Draw the field with the words to search for."""
        ui, theme = self.painter.ui, self.painter.theme
        left = round(170 * ui)
        plate = pygame.Rect(0, 0, min(round(340 * ui), right - left), round(34 * ui))
        plate.midright = right, header.centery
        edge = theme.selected if self.search.text else theme.key_edge
        self.painter.panel(surface, plate, theme.plate, 6 * ui, edge)
        inner = plate.inflate(-round(24 * ui), 0)
        if not self.page.places:
            words = "nothing like that"
            end = self.painter.write(surface, words, 13 * ui, theme.muted, midright=inner.midright)
            inner.width -= end.width
        fits = self.painter.fonts.width(HINT + MORE, 15 * ui) < inner.width
        self.search.draw(surface, inner, self.painter, 15 * ui, hint=HINT + MORE * fits)

    def _draw_line(self, surface: pygame.Surface, footer: pygame.Rect, pad: int) -> None:
        """Say more about the chosen card, and the command that opens it."""
        ui, theme, fonts = self.painter.ui, self.painter.theme, self.painter.fonts
        card = self.page.card
        if card is None:
            return
        command = fonts.shorten(" ".join(("mars2d", *card.command)), 13 * ui, 0.45 * footer.width)
        end, write = (footer.right - pad, footer.centery), self.painter.write
        place = write(surface, command, 13 * ui, theme.text, mono=True, midright=end)
        line = fonts.shorten(card.line, 14 * ui, place.left - 2 * pad)
        write(surface, line, 14 * ui, theme.muted, midleft=(pad, footer.centery))

    # -- events ---------------------------------------------------------------------------------

    def handle(self, event: pygame.Event) -> None:
        """Handle an event."""
        if event.type == pygame.QUIT:
            self._leave()
        elif self._buttons.handle(event):
            pass
        elif event.type == pygame.DROPFILE:
            self.open_file(Path(event.file))
        elif self._search(event):
            pass
        elif event.type == pygame.KEYDOWN:
            action = action_of(event, HOME)
            self._actions.get("" if action is None else action.name, lambda: None)()
        elif event.type == pygame.MOUSEWHEEL:
            self.page.turn(-event.y * NOTCH)
        elif event.type == pygame.MOUSEMOTION:
            card = self.page.at(event.pos)
            self.page.chosen = self.page.chosen if card is None else card
        elif event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT:
            self._click(event.pos)

    def _click(self, pixel: tuple[int, int]) -> None:
        card = self.page.at(pixel)
        if card is not None:
            self.page.chosen = card
            on = (command for place, command in self.page.buttons if place.collidepoint(pixel))
            self._choose(next(on, None))

    def _search(self, event: pygame.Event) -> bool:
        """Give an event to the field of search; return whether it was for it."""
        before = self.search.text
        taken = self.search.handle(event)
        if not self.search.text.strip():
            self.search.clear()
        if self.search.text != before:
            self.page.chosen = 0
            self.page.turn(-inf)  # where it is seen
        return taken

    def _watch(self) -> None:
        """Close with the other command of the chosen card, if it has one."""
        others = [] if self.page.card is None else [*self.page.card.others.values()]
        self._choose(others[-1] if others else None)

    def _escape(self) -> None:
        """Close the help, or forget what was typed."""
        if self.help.is_open:
            self.help.close()
        else:
            self.search.clear()

    def _leave(self) -> None:
        self._open = False

    def _choose(self, command: tuple[str, ...] | None = None) -> None:
        """Close with the chosen card, or with a command of one of its buttons."""
        if self.page.card is not None:
            self.choice, self._open = command or self.page.card.command, False

    def open_file(self, path: Path) -> None:
        """Close with a file that was dropped on the window, or say why it can't be opened."""
        command = OPENS.get(path.suffix.lower())
        if command is None:
            suffixes = ", ".join(OPENS)
            self._notes.say(f"{path.name}: expected a file that ends in {suffixes}", "warning")
        else:
            self.choice, self._open = (command, str(path)), False


@cache
def _words_of(name: str) -> str:
    """Return what is searched of an example: its course, its title in the window, its whole file.

    So its docstring is found, and the names of all parts that it uses.
    """
    file = examples()[name]
    course = next(course for course, names in courses().items() if name in names)
    return f"{course} {file.read_text(encoding='utf-8')}"


def _own_card(path: Path, picture: Path | None) -> Card:
    command = OPENS.get(path.suffix.lower(), "run")
    shown = picture if picture is not None and picture.exists() else None
    title = f"{path.parent.name}/{GAME}" if path.name == GAME else path.name
    return Card(title, str(path), (command, str(path)), shown, sign=path.suffix[1:])
