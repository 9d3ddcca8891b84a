"""What stands over the arena before a game: the roles to choose from, then the countdown."""

from __future__ import annotations

from functools import partial
from math import ceil

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.scenario.scenario import Scenario
from mars2d.window.run.play import Choice, Play
from mars2d.window.widgets.menu import Entry, Menu

NUMBER = 90.0
"""The height of the numbers of the countdown, points."""


class Countdown:
    """Draws over the arena before a game begins. menu: of the roles to choose from."""

    def __init__(self, painter: Painter, play: Play) -> None:
        """Start with nothing drawn."""
        self.painter, self.play = painter, play
        self.menu = Menu()
        self._scenario: Scenario | None = None

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event for the menu, or a number at the end; return whether it was taken."""
        if self.menu.handle(event):
            return True
        number = event.type == pygame.KEYDOWN and event.unicode.isdecimal()
        return bool(number) and self.play.choose(int(event.unicode))

    def draw(
        self,
        surface: pygame.Surface,
        room: pygame.Rect,
        area: pygame.Rect,
        scenario: Scenario,
    ) -> None:
        """Draw what there is to say now; area: of the picture, room: of the arena in it."""
        if not self.play.seats:
            self._offer(surface, room, area, scenario)
            return
        self.menu.close()
        if not self.play.counting:
            return
        ui, theme = self.painter.ui, self.painter.theme
        size = min(NUMBER * ui, room.height / 4)
        plate = pygame.Rect(0, 0, round(1.35 * size), round(1.35 * size))
        plate.midtop = room.centerx, room.top + round(6 * ui)
        self.painter.panel(surface, plate, theme.plate + "d0", plate.width / 2, theme.edge)
        number = str(ceil(self.play.counting))
        self.painter.write(surface, number, size, theme.ink, bold=True, center=plate.center)

    def _offer(
        self, surface: pygame.Surface, room: pygame.Rect, area: pygame.Rect, scenario: Scenario
    ) -> None:
        """Draw the menu of roles."""
        if not self.menu.is_open or scenario is not self._scenario:
            self._scenario = scenario
            self.menu.open("roles", lambda: self._entries(scenario), (0, 0), stays=True)
        plate = pygame.Rect((0, 0), self.menu.size(self.painter))
        plate.center = room.center
        self.menu.corner = plate.topleft
        self.menu.draw(surface, area, self.painter)

    def _entries(self, scenario: Scenario) -> list[Entry]:
        """Return the roles to choose from, and how each wins."""
        return [Entry("Who do you play?")] + [
            Entry(
                choice.title,
                partial(self.play.choose, choice.number),
                str(choice.number),
                colors=[scenario.colors[robot] for robot in choice.robots],
                more=self._aim(choice, scenario),
            )
            for choice in self.play.choices
        ]

    def _aim(self, choice: Choice, scenario: Scenario) -> str:
        """Return how a role wins; for two people, who has which keys."""
        contest = self.play.contest
        if len(choice.robots) > 1 or contest is None:
            return "arrow keys against W, A, S and D"
        return contest.aim(choice.title, scenario)
