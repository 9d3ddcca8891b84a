"""What stands over the arena before a game: the roles to choose from, then the countdown."""

from __future__ import annotations

from math import ceil

import pygame

from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.help import cap_width, draw_cap
from mars2d.window.play import Choice, Play
from mars2d.window.score_panel import draw_dot, draw_keys

__all__ = ["Countdown"]

PAD, ROW, TITLE, AIM = 20.0, 46.0, 40.0, 17.0
"""The margin, the heights of a choice, of the title and of a line below a choice, points."""
WIDTH = 420.0
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
        if not self.play.seats:
            self._draw_choices(surface, room, area, frame, pointer)
        elif self.play.counting:
            self._draw_number(surface, room)
            self._draw_people(surface, camera, frame)

    def _draw_number(self, surface: pygame.Surface, room: pygame.Rect) -> None:
        ui, theme = self.painter.ui, self.painter.theme
        size = min(NUMBER * ui, room.height / 3)
        number = str(ceil(self.play.counting))
        image = self.painter.fonts.render(number, size, theme.ink, bold=True)
        side = round(1.35 * size)
        plate = pygame.Rect(0, 0, side, side)
        plate.center = room.center
        self.painter.panel(surface, plate, theme.plate + "d0", side / 2, theme.edge)
        surface.blit(image, image.get_rect(center=room.center))

    def _draw_people(self, surface: pygame.Surface, camera: Camera, frame: Frame) -> None:
        """Draw the keys of each person beside the robot."""
        ui, fonts = self.painter.ui, self.painter.fonts
        for seat in self.play.seats:
            x, y = frame.pose[:2, seat.robot].tolist()
            ((left, top),) = camera.to_pixels([(x, y)]).astype(int).tolist()
            width = sum(cap_width(fonts, key, ui) for key in seat.keys) + round(10 * ui)
            plate = pygame.Rect(0, 0, width, round(40 * ui))
            away = camera.scale * frame.scenario.robots[seat.robot].radius + 34 * ui
            plate.center = left, round(top + (away if y >= 0 else -away))
            plate.clamp_ip(surface.get_rect())
            theme = self.painter.theme
            self.painter.panel(surface, plate, theme.plate, 8 * ui, theme.edge)
            draw_keys(surface, self.painter, seat.keys, (plate.left + round(8 * ui), plate.centery))

    def _draw_choices(
        self,
        surface: pygame.Surface,
        room: pygame.Rect,
        area: pygame.Rect,
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
        plate.center = room.center
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
