"""What stands over the arena before a game: the roles to choose from, then the countdown."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import product
from math import ceil, dist

import pygame

from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario
from mars2d.window.run.play import Choice, Play
from mars2d.window.run.score_panel import draw_dot, draw_keys
from mars2d.window.widgets.help import cap_width
from mars2d.window.widgets.menu import Entry, Menu

SPOTS = 9
"""How many places from left to right, and from top to bottom, are tried for a plate."""
NUMBER = 120.0
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
        camera: Camera,
        frame: Frame,
    ) -> None:
        """Draw what there is to say now; area: of the picture, room: of the arena in it."""
        robots = self._robots(camera, frame)
        if not self.play.seats:
            self._offer(surface, room, area, robots, frame.scenario)
            return
        self.menu.close()
        if self.play.counting:
            keys = self._draw_people(surface, room, robots, frame)
            self._draw_number(surface, room, [*robots, *keys])

    def _robots(self, camera: Camera, frame: Frame) -> list[pygame.Rect]:
        """Return where the robots are drawn."""
        pixels = camera.to_pixels(frame.pose[:2].T).astype(int).tolist()
        sizes = [ceil(2 * camera.scale * robot.radius) for robot in frame.scenario.robots]
        return [_about(pixel, size, size) for pixel, size in zip(pixels, sizes, strict=True)]

    def _draw_number(
        self, surface: pygame.Surface, room: pygame.Rect, taken: Sequence[pygame.Rect]
    ) -> None:
        ui, theme = self.painter.ui, self.painter.theme
        size = min(NUMBER * ui, room.height / 3)
        number = str(ceil(self.play.counting))
        image = self.painter.fonts.render(number, size, theme.ink, bold=True)
        side = round(1.35 * size)
        plate = _placed(pygame.Rect(0, 0, side, side), room, taken)
        self.painter.panel(surface, plate, theme.plate + "d0", side / 2, theme.edge)
        surface.blit(image, image.get_rect(center=plate.center))

    def _draw_people(
        self,
        surface: pygame.Surface,
        room: pygame.Rect,
        robots: Sequence[pygame.Rect],
        frame: Frame,
    ) -> list[pygame.Rect]:
        """Draw the keys of each person beside the robot; return where they are drawn."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        plates: list[pygame.Rect] = []
        for seat in self.play.seats:
            robot = robots[seat.robot]
            keys = sum(cap_width(fonts, key, ui) for key in seat.keys)
            plate = pygame.Rect(0, 0, keys + round(34 * ui), round(40 * ui))
            around = robot.inflate(round(2.2 * plate.width), round(3.2 * plate.height))
            plate = _placed(plate, around.clip(room), [*robots, *plates], robot.center)
            self.painter.panel(surface, plate, theme.plate, 8 * ui, theme.edge)
            color = theme.shade(frame.scenario.colors[seat.robot])
            left = plate.left + round(14 * ui)
            draw_dot(surface, self.painter, color, (left, plate.centery))
            draw_keys(surface, self.painter, seat.keys, (left + round(12 * ui), plate.centery))
            plates.append(plate)
        return plates

    def _offer(
        self, surface: pygame.Surface, room: pygame.Rect, area: pygame.Rect,
        robots: Sequence[pygame.Rect], scenario: Scenario,
    ) -> None:  # fmt: skip
        """Draw the menu of roles, beside the robots."""
        if not self.menu.is_open or scenario is not self._scenario:
            self._scenario = scenario
            self.menu.open("roles", lambda: self._entries(scenario), (0, 0), stays=True)
        size = self.menu.size(self.painter)
        self.menu.corner = _placed(pygame.Rect((0, 0), size), room, robots).topleft
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


def _about(pixel: Sequence[int], width: int, height: int) -> pygame.Rect:
    """Return a rectangle about a pixel."""
    place = pygame.Rect(0, 0, width, height)
    place.center = pixel[0], pixel[1]
    return place


def _placed(
    plate: pygame.Rect,
    room: pygame.Rect,
    taken: Sequence[pygame.Rect],
    near: tuple[int, int] | None = None,
) -> pygame.Rect:
    """Return a plate in a room, where it covers as few as possible of the places that are taken.

    near: a pixel from which it is as near as possible, by default the middle of the room.
    """
    aim, others = near or room.center, list(taken)
    places = []
    for x, y in product(range(SPOTS), range(SPOTS)):
        place = plate.copy()
        place.left = room.left + x * (room.width - plate.width) // (SPOTS - 1)
        place.top = room.top + y * (room.height - plate.height) // (SPOTS - 1)
        places.append(place)
    return min(places, key=lambda p: (len(p.collidelistall(others)), dist(p.center, aim)))
