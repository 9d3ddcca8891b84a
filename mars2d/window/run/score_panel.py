"""The panel of a game: time left, distance, the players with roles and keys, and the winner."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.scenario.roles import roles_of
from mars2d.window.run.play import NEXT, Play, Seat
from mars2d.window.widgets.help import row_of_keys
from mars2d.window.widgets.panel import DOT, Panel
from mars2d.window.widgets.rows import Row, Word

TIME, ROW, WORDS, GAP = 34.0, 24.0, 32.0, 8.0
"""The heights of the time left, a row, who has won, and gaps, points."""
SIZE, LARGE = 15.0, 22.0
"""The heights of letters, points."""
MAX_LINES = 3
"""The most lines of why a game has ended."""


class ScorePanel(Panel):
    """Shows how a game stands, the keys of those who play, and in the end who has won and why."""

    name, title, remembered = "score", "The game", False

    def __init__(self, painter: Painter, play: Play) -> None:
        """Start open."""
        super().__init__(painter)
        self.play, self.wanted = play, True

    def heights(self, frame: Frame, width: float) -> tuple[float, float]:
        """Return the height of how it stands, and that with how it has ended."""
        standing = sum(row.height for row in self._standing(frame, width))
        return standing, standing + sum(row.height for row in self._ending(frame, width))

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:
        """Return how it has ended, and how it stands."""
        return [*self._ending(frame, width), *self._standing(frame, width)]

    def _standing(self, frame: Frame, width: float) -> Iterator[Row]:
        """Yield the parts that are seen during a game."""
        play, scenario, theme = self.play, frame.scenario, self.painter.theme
        left = max(scenario.stop_time - frame.time, 0.0)
        at_end = Word(f"{left:.1f} s", theme.ink, 24, bold=True)
        yield self.line([Word("time left", theme.muted)], [at_end], TIME)
        distance = play.distance(frame)
        if distance is not None:
            at_end = Word(f"{distance:.2f} m", theme.ink, SIZE, bold=True)
            yield self.line([Word("distance", theme.muted)], [at_end], ROW)
        yield Row(GAP, self._rule)
        score = play.score()
        for role, team in roles_of(scenario).items():
            seats = [seat for seat in play.seats if seat.robot in team]
            about = role, play.played_by(role), score.get(role, "")
            yield from self._role(frame, team[0], about, seats, width)
        for seat in play.seats:
            if not seat.role:
                about = str(scenario.robots[seat.robot].name), "you", ""
                yield from self._role(frame, seat.robot, about, [seat], width)
        for role, wins in play.tally.items():
            yield from self._text(f"so far as {role}: won {sum(wins)} of {len(wins)}", width, 2)

    def _role(
        self,
        frame: Frame,
        robot: int,
        about: tuple[str, str, str],
        seats: Sequence[Seat],
        width: float,
    ) -> Iterator[Row]:
        """Yield a role, who plays it, its points, and for each person the keys and the aim."""
        theme, contest = self.painter.theme, self.play.contest
        role, by, points = about
        dot = Word(DOT, theme.shade(frame.scenario.colors[robot]), SIZE)
        words = dot, Word(role, theme.ink, SIZE, bold=True), Word(by, theme.muted)
        yield self.line(words, [Word(points, theme.ink, SIZE, bold=True)], ROW)
        for seat in seats:
            yield row_of_keys(self.painter, seat.keys, [""])
            if contest is not None and seat.role:
                yield from self._text(contest.aim(seat.role, frame.scenario), width, 2)
            elif contest is None:
                yield from self._text(self.play.task, width, MAX_LINES)
            yield self.gap(GAP / 2)

    def _ending(self, frame: Frame, width: float) -> Iterator[Row]:
        """Yield how a game has ended, why, and the keys to go on with; nothing before."""
        result, theme = self.play.result, self.painter.theme
        if result is None:
            return
        yield self.line([Word(result.words, theme.running.ink, LARGE, bold=True)], high=WORDS)
        yield from self._text(frame.over_message, width, MAX_LINES)
        yield row_of_keys(self.painter, ["R"], ["play again"])
        yield row_of_keys(self.painter, [str(NEXT)], ["next start"])
        numbers = tuple(str(choice.number) for choice in self.play.choices)
        if numbers:
            yield row_of_keys(self.painter, numbers, ["other roles"])
        yield Row(GAP, self._rule)

    def _text(self, text: str, width: float, most: int) -> Iterator[Row]:
        """Yield lines of text."""
        yield from self.wrapped(Word(text, self.painter.theme.text), width, most)

    def _rule(self, surface: pygame.Surface, rect: pygame.Rect) -> None:
        surface.fill(self.painter.theme.edge, (rect.left, rect.centery, rect.width, 1))
