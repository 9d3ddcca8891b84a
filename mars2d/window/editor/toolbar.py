"""The toolbar: a button for each tool and one for snapping to the grid, with their icons."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pygame

from mars2d.bodies.colors import NEUTRAL, OBSTACLE
from mars2d.core.scene import INK, PALETTE, Scene, faded
from mars2d.output.layers.bodies import prop_edge
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.window.editor.chrome import draw_plate
from mars2d.window.editor.handles import MARK, PAPER
from mars2d.window.editor.keys import TOOLS, VIEW
from mars2d.window.widgets.keys import Key

WIDTH = 58.0
"""The toolbar's width, points."""

SIDE, GAP = 46.0, 2.0
"""A button's side, and the gap between two, points."""
LAMP = "#e8c500"
WOOD = prop_edge(NEUTRAL)

(SNAP,) = (key for key in VIEW if key.action == "snap")


class Toolbar:
    """A column of buttons at the left of the window."""

    def __init__(self, painter: Painter) -> None:
        """Start with nothing drawn."""
        self._painter = painter
        self._places: list[tuple[Key, pygame.Rect]] = []

    def arrange(self, area: pygame.Rect, ui: float) -> None:
        """Lay out the buttons in an area, smaller if they would not fit."""
        count = len(TOOLS) + 1.6
        side = min(SIDE * ui, (area.height - 12 * ui) / count - GAP * ui)
        side = round(max(side, 8))
        x = area.centerx - side // 2
        step = side + round(GAP * ui)
        top = area.top + round(6 * ui)
        self._places = [
            (key, pygame.Rect(x, top + i * step, side, side)) for i, key in enumerate(TOOLS)
        ]
        low = top + round((len(TOOLS) + 0.25) * step)
        self._places.append((SNAP, pygame.Rect(x, low, side, side)))

    def at(self, pixel: tuple[int, int]) -> Key | None:
        """Return the key of the button at a pixel, if there is one."""
        return next((key for key, place in self._places if place.collidepoint(pixel)), None)

    def draw(
        self,
        surface: pygame.Surface,
        area: pygame.Rect,
        chosen: str,
        pointer: tuple[int, int],
        *,
        snaps: bool,
        step: str,
    ) -> None:
        """Draw all buttons; chosen: the tool in use; step: the grid's step, in words."""
        painter, theme = self._painter, self._painter.theme
        surface.fill(theme.bar, area)
        surface.fill(theme.edge, (area.right - 1, area.top, 1, area.height))
        for key, place in self._places:
            on = snaps if key is SNAP else key.action == chosen
            hover = place.collidepoint(pointer)
            if on or hover:
                fill = theme.running.pale if on else theme.key
                edge = theme.selected if on else theme.key_edge
                painter.panel(surface, place, fill, 0.18 * place.width, edge)
            _draw_icon(surface, painter, key.action, place)
            size = 0.23 * place.width
            color = theme.running.ink if on else theme.muted
            letter = painter.fonts.render(key.labels[0], size, color, bold=True)
            corner = (place.right - 0.09 * place.width, place.bottom - 0.05 * place.width)
            surface.blit(letter, letter.get_rect(bottomright=(round(corner[0]), round(corner[1]))))
        _, place = self._places[-1]
        words = painter.fonts.render(step if snaps else "free", 0.26 * place.width, theme.text)
        surface.blit(words, words.get_rect(midtop=(place.centerx, place.bottom + 2)))

    def draw_tip(
        self, surface: pygame.Surface, pointer: tuple[int, int], bounds: pygame.Rect
    ) -> None:
        """Draw the help of the button under the pointer."""
        gap = round(10 * self._painter.ui)
        for key, place in self._places:
            if place.collidepoint(pointer):
                words, beside = key.help[0].upper() + key.help[1:], place.move(gap, 0).midright
                draw_plate(surface, self._painter, [words], bounds, midleft=beside)


def _draw_icon(surface: pygame.Surface, painter: Painter, name: str, place: pygame.Rect) -> None:
    """Draw the icon of a tool, defined in the square from -1 to 1, in the middle of a rectangle."""
    scene = Scene()
    ICONS[name](scene)
    side = 0.27 * place.width
    x, y = place.centerx - 0.05 * place.width, place.centery - 0.06 * place.height
    before, painter.ui = painter.ui, place.width / SIDE
    painter.paint(surface, scene.shapes, Camera(side, x, y))
    painter.ui = before


def _select(scene: Scene) -> None:
    arrow = [(-0.5, 0.95), (-0.5, -0.6), (-0.13, -0.27), (0.14, -0.9), (0.4, -0.79), (0.13, -0.18),
             (0.62, -0.18)]  # fmt: skip
    scene.polygon(arrow, fill=PAPER, stroke=INK, width=1.6)


def _robot(scene: Scene) -> None:
    scene.circle((0, 0), 0.85, fill=PALETTE[0])
    scene.line([(0, 0), (0.6, 0.6)], stroke="#ffffff", width=2.4)


def _box(scene: Scene) -> None:
    square = [(-0.75, -0.75), (0.75, -0.75), (0.75, 0.75), (-0.75, 0.75)]
    scene.polygon(square, fill=NEUTRAL, stroke=WOOD, width=1.5)


def _ball(scene: Scene) -> None:
    scene.circle((0, 0), 0.75, fill=NEUTRAL, stroke=WOOD, width=1.5)
    scene.circle((-0.22, 0.25), 0.17, fill=PAPER)


def _wall(scene: Scene) -> None:
    corners = [(-0.9, -0.7), (-0.5, 0.6), (0.5, 0.2), (0.9, 0.85)]
    scene.line(corners, stroke=INK, width=2.5)
    for corner in corners:
        scene.circle(corner, 0.0, fill=PAPER, stroke=INK, width=1.2, pixels=2.2)


def _polygon(scene: Scene) -> None:
    corners = [(-0.85, -0.6), (0.25, -0.85), (0.95, 0.1), (0.05, 0.25), (-0.35, 0.9)]
    scene.polygon(corners, fill=OBSTACLE, stroke=INK, width=1.5)
    for corner in corners:
        scene.circle(corner, 0.0, fill=PAPER, stroke=INK, width=1.0, pixels=1.9)


def _rectangle(scene: Scene) -> None:
    corners = [(-0.95, -0.6), (0.95, -0.6), (0.95, 0.6), (-0.95, 0.6)]
    scene.polygon(corners, fill=OBSTACLE, stroke=INK, width=1.5)


def _waypoint(scene: Scene) -> None:
    places = [(-0.85, -0.7), (-0.2, 0.15), (0.6, -0.25), (0.75, 0.75)]
    scene.line(places, stroke=PALETTE[0], width=1.4, style=":")
    for place in places[1:]:
        scene.circle(place, 0.0, fill=PALETTE[0], pixels=2.8)
    scene.circle(places[-1], 0.33, stroke=PALETTE[0], width=1.2)


def _beacon(scene: Scene) -> None:
    scene.circle((0, 0), 0.4, fill=LAMP, stroke=INK, width=1.0)
    for angle in np.arange(8) * np.pi / 4:
        c, s = float(np.cos(angle)), float(np.sin(angle))
        scene.line([(0.62 * c, 0.62 * s), (0.98 * c, 0.98 * s)], stroke=WOOD, width=1.6)


def _workspace(scene: Scene) -> None:
    corners = [(-0.85, -0.85), (0.85, -0.85), (0.85, 0.4), (0.3, 0.85), (-0.85, 0.85)]
    scene.polygon(corners, fill=faded(MARK, 0.1), stroke=MARK, width=1.3)
    for x, y in corners:
        a = 0.17
        square = [(x - a, y - a), (x + a, y - a), (x + a, y + a), (x - a, y + a)]
        scene.polygon(square, fill=PAPER, stroke=MARK, width=1.2)


def _snap(scene: Scene) -> None:
    for k in (-0.7, 0.0, 0.7):
        scene.line([(k, -0.95), (k, 0.95)], stroke=faded(INK, 0.55), width=1.0)
        scene.line([(-0.95, k), (0.95, k)], stroke=faded(INK, 0.55), width=1.0)
    scene.circle((0.0, 0.0), 0.24, fill=MARK)


ICONS: dict[str, Callable[[Scene], None]] = {
    "select": _select,
    "robot": _robot,
    "box": _box,
    "ball": _ball,
    "wall": _wall,
    "polygon": _polygon,
    "rectangle": _rectangle,
    "waypoint": _waypoint,
    "beacon": _beacon,
    "workspace": _workspace,
    "snap": _snap,
}
