"""What stands over the arena before a game: the roles to choose from, then the countdown."""

from __future__ import annotations

from functools import partial
from math import ceil

import pygame

from mars2d.output.raster.painter import Painter
from mars2d.window.run.play import Choice, Play
from mars2d.window.widgets.menu import Entry

NUMBER = 90.0
"""The height of the numbers of the countdown, points."""


def draw_countdown(
    surface: pygame.Surface, room: pygame.Rect, painter: Painter, seconds: float
) -> None:
    """Draw how many seconds are left; room: of the arena."""
    ui, theme = painter.ui, painter.theme
    size = min(NUMBER * ui, room.height / 4)
    plate = pygame.Rect(0, 0, round(1.35 * size), round(1.35 * size))
    plate.midtop = room.centerx, room.top + round(6 * ui)
    painter.panel(surface, plate, theme.plate + "d0", plate.width / 2, theme.edge)
    painter.write(surface, str(ceil(seconds)), size, theme.ink, bold=True, center=plate.center)


def entries_of_roles(play: Play) -> list[Entry]:
    """Return the roles to choose from, and how each wins."""
    colors = play.scenario.colors
    return [Entry("Who do you play?")] + [
        Entry(
            choice.title,
            partial(play.choose, choice.number),
            str(choice.number),
            colors=[colors[robot] for robot in choice.robots],
            more=_aim(choice, play),
        )
        for choice in play.choices
    ]


def _aim(choice: Choice, play: Play) -> str:
    """Return how a role wins; for two people, who has which keys."""
    contest = play.contest
    if len(choice.robots) > 1 or contest is None:
        return "arrow keys against W, A, S and D"
    return contest.aim(choice.title, play.scenario)
