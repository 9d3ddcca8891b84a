"""The icons of the tools, each drawn in the square from -1 to 1."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pygame

from mars2d.core.scene import PALETTE, Scene, faded
from mars2d.output.layers.bodies import INK, NEUTRAL, OBSTACLE, prop_edge
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.window.editor.handles import MARK, PAPER

__all__ = ["draw_icon"]

DRAWN_FOR = 46.0
"""The lines of icons are as wide as befits buttons of so many pixels."""

LAMP = "#e8c500"
WOOD = prop_edge(NEUTRAL)


def draw_icon(surface: pygame.Surface, painter: Painter, name: str, place: pygame.Rect) -> None:
    """Draw the icon of a tool in the middle of a rectangle."""
    scene = Scene()
    ICONS[name](scene)
    side = 0.27 * place.width
    x, y = place.centerx - 0.05 * place.width, place.centery - 0.06 * place.height
    before, painter.ui = painter.ui, place.width / DRAWN_FOR
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
