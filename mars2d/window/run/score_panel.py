"""The panel of a game: time left, distance, the players with roles and keys, and the winner."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.scenario.roles import roles_of
from mars2d.window.run.play import Play, Result, Seat
from mars2d.window.widgets.dock import Panel
from mars2d.window.widgets.help import draw_cap

TIME, ROW, LINE, KEYS, WORDS, GAP = 34.0, 24.0, 18.0, 36.0, 32.0, 8.0
"""The heights of the time left, a row, a line of text, keys, who has won, and gaps, points."""
DOT = 11.0
"""The diameter of a robot's dot, points."""
SMALL, SIZE = 13.0, 15.0
"""The heights of letters, points."""
MAX_LINES = 3
"""The most lines of why a game has ended."""


class Part(NamedTuple):
    """A part of the panel: its height [points], and the function that draws it."""

    height: float
    draw: Callable[[pygame.Surface, pygame.Rect], None]


GAP_PART = Part(GAP / 2, lambda _surface, _rect: None)


class ScorePanel(Panel):
    """Shows how a game stands, the keys of those who play, and in the end who has won and why."""

    name, title, remembered = "score", "The game", False

    def __init__(self, painter: Painter, play: Play) -> None:
        """Start open."""
        self.painter, self.play = painter, play
        self.is_open = True

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the height of how it stands, and that with how it has ended."""
        standing = sum(part.height for part in self._standing(frame, width))
        end = sum(part.height for part in self._ending(frame, width))
        return standing, standing + end

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:
        """Draw the parts one below the other, as many as there is room for."""
        ui, top, width = self.painter.ui, float(rect.top), rect.width / self.painter.ui
        for height, draw in [*self._ending(frame, width), *self._standing(frame, width)]:
            if top + height * ui > rect.bottom + 1:
                break
            draw(surface, pygame.Rect(rect.left, round(top), rect.width, round(height * ui)))
            top += height * ui

    def _standing(self, frame: Frame, width: float) -> Iterator[Part]:
        """Yield the parts that are seen during a game."""
        play, scenario = self.play, frame.scenario
        left = max(scenario.stop_time - frame.time, 0.0)
        yield Part(TIME, partial(self._row, "time left", f"{left:.1f} s", large=True))
        distance = play.distance(frame)
        if distance is not None:
            yield Part(ROW, partial(self._row, "distance", f"{distance:.2f} m"))
        yield Part(GAP, self._line)
        score = play.score()
        for role, team in roles_of(scenario).items():
            points = score.get(role, "")
            color = self.painter.theme.shade(scenario.colors[team[0]])
            yield Part(ROW, partial(self._role, color, role, play.played_by(role), points))
            for seat in play.seats:
                if seat.robot in team:
                    yield from self._of_seat(seat, frame, width)
        for seat in play.seats:
            if not seat.role:
                color = self.painter.theme.shade(scenario.colors[seat.robot])
                name = str(scenario.robots[seat.robot].name)
                yield Part(ROW, partial(self._role, color, name, "you", ""))
                yield from self._of_seat(seat, frame, width)
        if words := self._tally():
            yield Part(GAP, self._line)
            yield from self._wrapped(words, width, 2)

    def _of_seat(self, seat: Seat, frame: Frame, width: float) -> Iterator[Part]:
        """Yield a person's keys, and how the role wins."""
        yield Part(KEYS, partial(self._keys, seat))
        contest = self.play.contest
        if contest is not None and seat.role:
            yield from self._wrapped(contest.aim(seat.role, frame.scenario), width, 2)
        yield GAP_PART

    def _ending(self, frame: Frame, width: float) -> Iterator[Part]:
        """Yield how a game has ended, why, and the keys to go on with; nothing before."""
        result = self.play.result
        if result is None:
            return
        yield Part(WORDS, partial(self._words, result))
        yield from self._wrapped(frame.over_message, width, MAX_LINES)
        yield from self._wrapped(result.news, width, 2)
        yield Part(KEYS, partial(self._key, ("R",), "play again"))
        numbers = tuple(str(choice.number) for choice in self.play.choices)
        if numbers:
            yield Part(KEYS, partial(self._key, numbers, "other roles"))
        yield Part(GAP, self._line)

    def _wrapped(self, text: str, width: float, most: int) -> Iterator[Part]:
        """Yield lines of text."""
        ui = self.painter.ui
        for line in self.painter.fonts.wrap(text, SMALL * ui, width * ui, most) if text else ():
            yield Part(LINE, partial(self._text, line))

    def _tally(self) -> str:
        """Return the games won so far, by one person or by the first role of two."""
        seats = [seat for seat in self.play.seats if seat.role]
        words = self.play.tally(seats[0].role).in_words if seats else ""
        who = f" as {seats[0].role}" if seats else ""
        return f"so far{who}: {words}" if words else ""

    # -- drawing ------------------------------------------------------------------------------

    def _row(
        self,
        name: str,
        value: str,
        surface: pygame.Surface,
        rect: pygame.Rect,
        *,
        large: bool = False,
    ) -> None:
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        label = fonts.render(name, SMALL * ui, theme.muted)
        surface.blit(label, label.get_rect(midleft=(rect.left, rect.centery)))
        size = 24 if large else SIZE
        image = fonts.render(value, size * ui, theme.ink, bold=True)
        surface.blit(image, image.get_rect(midright=(rect.right, rect.centery)))

    def _role(
        self,
        color: str,
        role: str,
        by: str,
        points: str,
        surface: pygame.Surface,
        rect: pygame.Rect,
    ) -> None:
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        draw_dot(surface, self.painter, color, (rect.left + round(DOT / 2 * ui), rect.centery))
        name = fonts.render(role, SIZE * ui, theme.ink, bold=True)
        x = rect.left + round((DOT + 8) * ui)
        surface.blit(name, name.get_rect(midleft=(x, rect.centery)))
        x += name.get_width() + round(8 * ui)
        number = fonts.render(points, SIZE * ui, theme.ink, bold=True)
        place = number.get_rect(midright=(rect.right, rect.centery))
        surface.blit(number, place)
        room = place.left - x - round(8 * ui)
        who = fonts.render(fonts.shorten(by, SMALL * ui, room), SMALL * ui, theme.muted)
        surface.blit(who, who.get_rect(midleft=(x, rect.centery)))

    def _keys(self, seat: Seat, surface: pygame.Surface, rect: pygame.Rect) -> None:
        draw_keys(surface, self.painter, seat.keys, rect.midleft)

    def _key(
        self, keys: tuple[str, ...], does: str, surface: pygame.Surface, rect: pygame.Rect
    ) -> None:
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        x = draw_keys(surface, self.painter, keys, rect.midleft)
        words = fonts.render(does, SIZE * ui, theme.text)
        surface.blit(words, words.get_rect(midleft=(x + round(4 * ui), rect.centery)))

    def _words(self, result: Result, surface: pygame.Surface, rect: pygame.Rect) -> None:
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        text = fonts.shorten(result.words, 22 * ui, rect.width, bold=True)
        image = fonts.render(text, 22 * ui, theme.running.ink, bold=True)
        surface.blit(image, image.get_rect(midleft=rect.midleft))

    def _text(self, text: str, surface: pygame.Surface, rect: pygame.Rect) -> None:
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        image = fonts.render(fonts.shorten(text, SMALL * ui, rect.width), SMALL * ui, theme.text)
        surface.blit(image, image.get_rect(midleft=rect.midleft))

    def _line(self, surface: pygame.Surface, rect: pygame.Rect) -> None:
        surface.fill(self.painter.theme.edge, (rect.left, rect.centery, rect.width, 1))


def draw_dot(
    surface: pygame.Surface, painter: Painter, color: str, middle: tuple[int, int]
) -> None:
    """Draw a dot in a robot's colour."""
    side = round(DOT * painter.ui)
    dot = pygame.Rect(0, 0, side, side)
    dot.center = middle
    painter.panel(surface, dot, color, side / 2)


def draw_keys(
    surface: pygame.Surface, painter: Painter, keys: tuple[str, ...], left: tuple[int, int]
) -> int:
    """Draw the caps of keys in a row from its left end, pixels; return where it ends."""
    x, y = left
    for key in keys:
        x = draw_cap(surface, painter, key, x, y, painter.ui)
    return x
