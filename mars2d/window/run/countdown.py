"""What stands over the arena before a game: the roles to choose from, then the countdown."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from math import ceil, dist

import pygame

from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.run.play import Choice, Play
from mars2d.window.run.score_panel import draw_dot, draw_keys
from mars2d.window.widgets.help import cap_width, draw_cap

PAD, ROW, TITLE, AIM = 20.0, 46.0, 40.0, 17.0
"""The margin, the heights of a choice, of the title and of a line below a choice, points."""
WIDTH = 420.0
SPOTS = 9
"""How many places from left to right, and from top to bottom, are tried for a plate."""
NUMBER = 120.0
"""The height of the numbers of the countdown, points."""


class Countdown:
    """Draws over the arena before a game begins. places: where choices were drawn, by number."""

    def __init__(self, painter: Painter, play: Play) -> None:
        """Start with nothing drawn."""
        self.painter, self.play = painter, play
        self.places: dict[int, pygame.Rect] = {}

    def handle(self, event: pygame.Event) -> bool:
        """Handle a press of a mouse button or a number; return whether it has chosen roles."""
        if event.type == pygame.KEYDOWN and event.unicode.isdecimal():
            return self.play.choose(int(event.unicode))
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == pygame.BUTTON_LEFT:
            found = (n for n, place in self.places.items() if place.collidepoint(event.pos))
            return self.play.choose(next(found, 0))
        return False

    def draw(
        self,
        surface: pygame.Surface,
        room: pygame.Rect,
        area: pygame.Rect,
        camera: Camera,
        frame: Frame,
        pointer: tuple[int, int] | None,
    ) -> None:
        """Draw what there is to say now; area: of the picture, room: of the arena in it."""
        self.places = {}
        robots = self._robots(camera, frame)
        if not self.play.seats:
            self._draw_choices(surface, room, area, robots, frame, pointer)
        elif self.play.counting:
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

    def _draw_choices(
        self,
        surface: pygame.Surface,
        room: pygame.Rect,
        area: pygame.Rect,
        robots: Sequence[pygame.Rect],
        frame: Frame,
        pointer: tuple[int, int] | None,
    ) -> None:
        """Draw the roles to choose from, each as a button."""
        ui, fonts, theme = self.painter.ui, self.painter.fonts, self.painter.theme
        scenario, choices = frame.scenario, self.play.choices
        pad, row = round(PAD * ui), round((ROW + AIM) * ui)
        aims = [self._aim(choice, frame) for choice in choices]
        needed = max(fonts.width(aim, 13.5 * ui) for aim in aims) + round(130 * ui)
        width = min(max(round(WIDTH * ui), needed), area.width - 2 * pad)
        plate = pygame.Rect(0, 0, width, round(TITLE * ui) + row * len(choices) + 2 * pad)
        plate = _placed(plate, room, robots)
        plate.clamp_ip(area)
        self.painter.panel(surface, plate, theme.plate, 10 * ui, theme.edge)
        title = fonts.render("Who do you play?", 20 * ui, theme.ink, bold=True)
        surface.blit(title, (plate.left + pad, plate.top + pad))
        for k, choice in enumerate(choices):
            place = pygame.Rect(
                plate.left + pad // 2, plate.top + pad + round(TITLE * ui) + k * row,
                width - pad, row - round(4 * ui),
            )  # fmt: skip
            self.places[choice.number] = place
            over = pointer is not None and place.collidepoint(pointer)
            if over:
                self.painter.panel(surface, place, theme.key, 6 * ui)
            middle = place.top + round(ROW / 2 * ui)
            left = place.left + pad // 2
            x = draw_cap(surface, self.painter, str(choice.number), left, middle, ui)
            for robot in choice.robots:
                color = theme.shade(scenario.colors[robot])
                draw_dot(surface, self.painter, color, (x + round(10 * ui), middle))
                x += round(18 * ui)
            words = fonts.render(choice.title, 17 * ui, theme.ink, bold=True)
            surface.blit(words, words.get_rect(midleft=(x + round(8 * ui), middle)))
            text = fonts.shorten(aims[k], 13.5 * ui, place.right - x - round(8 * ui))
            image = fonts.render(text, 13.5 * ui, theme.muted)
            surface.blit(image, (x + round(8 * ui), place.top + round((ROW - 8) * ui)))

    def _aim(self, choice: Choice, frame: Frame) -> str:
        """Return how a role wins; for two people, who has which keys."""
        contest = self.play.contest
        if len(choice.robots) > 1 or contest is None:
            return "arrow keys against W, A, S and D"
        return contest.aim(choice.title, frame.scenario)


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
