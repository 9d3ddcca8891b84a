"""The panel of a game: time left, distance, who plays what by which keys, and who has won."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import pygame

from mars2d.output.raster.bars import decimals
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.scenario.roles import roles_of
from mars2d.window.dock import Panel
from mars2d.window.help import cap_width, draw_cap
from mars2d.window.play import Play, Result, Seat

__all__ = ["ScorePanel", "draw_dot", "draw_keys"]

TIME, ROW, LINE, KEYS, WORDS, GAP = 34.0, 24.0, 18.0, 36.0, 32.0, 8.0
"""The heights of the time left, a row, a line of text, keys, who has won, and gaps, points."""
DOT = 11.0
"""The diameter of a robot's dot, points."""
SMALL, SIZE = 13.0, 15.0
"""The heights of letters, points."""
MAX_LINES = 3
"""The most lines of why a game has ended."""


class Part(NamedTuple):
    """A part of the panel: its height [points], and what draws it within a rectangle."""

    height: float
    draw: Callable[[pygame.Surface, pygame.Rect], None]


class ScorePanel(Panel):
    """Shows how a game stands, the keys of those who play, and in the end who has won and why."""

    name, title, remembered = "score", "The game", False

    def __init__(self, painter: Painter, play: Play) -> None:
        """Start open."""
        self.painter, self.play = painter, play
        self.is_open = True

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the height of all parts, with room for the end of the game."""
        height = sum(part.height for part in self._parts(frame, width))
        if self.play.result is None:
            height += GAP + WORDS + LINE * (MAX_LINES + 1) + ROW
        return height, height

    def draw(self, surface: pygame.Surface, rect: pygame.Rect, frame: Frame) -> None:
        """Draw the parts one below the other."""
        ui, top = self.painter.ui, float(rect.top)
        for height, draw in self._parts(frame, rect.width / ui):
            draw(surface, pygame.Rect(rect.left, round(top), rect.width, round(height * ui)))
            top += height * ui

    def _parts(self, frame: Frame, width: float) -> Iterator[Part]:
        play, scenario, fonts = self.play, frame.scenario, self.painter.fonts
        digits = decimals(scenario)
        left = max(scenario.stop_time - frame.time, 0.0)
        yield Part(TIME, partial(self._row, "time left", f"{left:.{digits}f} s", large=True))
        distance = play.distance(frame)
        if distance is not None:
            yield Part(ROW, partial(self._row, "distance", f"{distance:.2f} m"))
        yield Part(GAP, self._line)
        score = play.score()
        for role, team in roles_of(scenario).items():
            points = f"{score[role]:g}" if role in score else ""
            color = self.painter.theme.shade(scenario.colors[team[0]])
            yield Part(ROW, partial(self._role, color, role, play.played_by(role), points))
            for seat in play.seats:
                if seat.robot in team:
                    yield from self._of_seat(seat, frame, width)
        for seat in play.seats:
            if not seat.role:
                yield Part(ROW, partial(self._text, f"you: {scenario.robots[seat.robot].name}"))
                yield from self._of_seat(seat, frame, width)
        if play.result is not None:
            yield from self._of_result(play.result, frame.over_message, width)
        elif play.seats and (words := self._tally(fonts.width, width)):
            yield Part(GAP, self._line)
            yield Part(LINE, partial(self._text, words))

    def _of_seat(self, seat: Seat, frame: Frame, width: float) -> Iterator[Part]:
        """Yield a person's keys, and how the role wins."""
        yield Part(KEYS, partial(self._keys, seat))
        contest, ui = self.play.contest, self.painter.ui
        aim = contest.aim(seat.role, frame.scenario) if contest is not None and seat.role else ""
        lines = self.painter.fonts.wrap(aim, SMALL * ui, width * ui, 2) if aim else []
        for line in lines:
            yield Part(LINE, partial(self._text, line))
        yield Part(GAP / 2, lambda *_: None)

    def _of_result(self, result: Result, why: str, width: float) -> Iterator[Part]:
        fonts, ui, play = self.painter.fonts, self.painter.ui, self.play
        yield Part(GAP, self._line)
        yield Part(WORDS, partial(self._words, result))
        for text, most in ((why, MAX_LINES), (result.record, 2)):
            for line in fonts.wrap(text, SMALL * ui, width * ui, most) if text else ():
                yield Part(LINE, partial(self._text, line))
        if words := self._tally(fonts.width, width):
            yield Part(LINE, partial(self._text, words))
        yield Part(GAP / 2, lambda *_: None)
        yield Part(KEYS, partial(self._key, "R", "play again"))
        for choice in play.choices:
            yield Part(KEYS, partial(self._key, str(choice.number), f"as {choice.title}"))

    def _tally(self, measure: Callable[[str, float], int], width: float) -> str:
        """Return what was won so far, as far as it has room."""
        seats = [seat for seat in self.play.seats if seat.role]
        words = self.play.tally(seats[0].role).in_words if seats else ""
        who = "" if len(seats) == 1 else f" as {seats[0].role}" if seats else ""
        whole = f"so far{who}: {words}" if words else ""
        return whole

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

    def _key(self, key: str, does: str, surface: pygame.Surface, rect: pygame.Rect) -> None:
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        x = draw_cap(surface, self.painter, key, rect.left, rect.centery, ui)
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
) -> None:
    """Draw the caps of keys in a row from its left end, pixels."""
    x, y = left
    for key in keys:
        x = draw_cap(surface, painter, key, x, y, painter.ui)
