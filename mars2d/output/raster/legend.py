"""The legends of forces and velocities, in a corner of the picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pygame

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.forces import FORCE, SLIP, SLIP_EDGE, force_scale, in_newtons, round_force
from mars2d.output.layers.velocities import VELOCITY, in_metres_a_second, speed_scale
from mars2d.output.raster.camera import PIXELS, Camera
from mars2d.output.raster.painter import Painter
from mars2d.scenario.scenario import Scenario

__all__ = ["draw_legends"]

MAX_ARROW = 72.0
"""The greatest length of an arrow, points; it means 1, 2, 5, 10 ... newtons or metres a second."""

MIN_HEIGHT = 300.0
"""The least height of a picture with a legend, points; the least width is twice that."""

GAP, PAD, ROW_HEIGHT, TEXT_SIZE = 8.0, 10.0, 24.0, 13.0
"""The room around a plate and within it, the heights of a row and of text, points."""


@dataclass(frozen=True, slots=True)
class _Legend:
    """An arrow of a round length in its unit, and a mark with its meaning.

    unit: the length of one unit, pixels. width: of the arrow, points. in_words: formats a number of
    units. draw_mark: draws the mark at (x, y), given pixels per point. room: of the mark, points.
    """

    color: str
    unit: float
    width: float
    in_words: Callable[[float], str]
    meaning: str
    draw_mark: Callable[[Scene, float, float, float], None]
    room: float


def draw_legends(
    surface: pygame.Surface,
    painter: Painter,
    scenario: Scenario,
    camera: Camera,
    plot: pygame.Rect,
    *,
    forces: bool,
    velocities: bool,
) -> None:
    """Draw the chosen legends side by side, if the picture has room for them."""
    if plot.height < MIN_HEIGHT * painter.ui or plot.width < 2 * MIN_HEIGHT * painter.ui:
        return
    corner = plot.bottomleft
    if forces:
        scale = force_scale(scenario)
        unit = scale.newton * camera.scale
        legend = _Legend(FORCE, unit, scale.width, in_newtons, "slips", _slipping, 18.0)
        corner = _draw(surface, painter, legend, corner).right, plot.bottom
    if velocities:
        speed = speed_scale(scenario)
        unit, words = speed.meter_a_second * camera.scale, in_metres_a_second
        legend = _Legend(VELOCITY, unit, speed.width, words, "turn in 1 s", _turning, 24.0)
        _draw(surface, painter, legend, corner)


def _draw(
    surface: pygame.Surface, painter: Painter, legend: _Legend, corner: tuple[int, int]
) -> pygame.Rect:
    """Draw a legend on a plate to the upper right of a corner; return the plate."""
    ui, theme, fonts = painter.ui, painter.theme, painter.fonts
    number = round_force(MAX_ARROW * ui / legend.unit)
    length = number * legend.unit
    size, pad, row, gap = TEXT_SIZE * ui, PAD * ui, ROW_HEIGHT * ui, GAP * ui
    words = (legend.in_words(number), legend.meaning)
    column = max(length, legend.room * ui)
    width = pad + column + gap + max(fonts.width(word, size) for word in words) + pad
    plate = pygame.Rect(0, 0, round(width), round(2 * row + gap))
    plate.bottomleft = (corner[0] + round(gap), corner[1] - round(gap))
    painter.panel(surface, plate, faded(theme.plate, 0.9), gap, theme.edge)
    left, middle = plate.left + pad, plate.top + 4 * ui + row / 2
    scene = Scene()
    ends = (left, -middle), (left + length, -middle)
    scene.arrow(*ends, fill=legend.color, width=legend.width)
    legend.draw_mark(scene, left + column / 2, -middle - row, ui)
    painter.paint(surface, scene.shapes, PIXELS)
    for k, word in enumerate(words):
        image = fonts.render(word, size, theme.text)
        place = image.get_rect(midleft=(round(left + column + gap), round(middle + k * row)))
        surface.blit(image, place)
    return plate


def _slipping(scene: Scene, x: float, y: float, ui: float) -> None:  # noqa: ARG001
    """Draw the mark of a drive that slips."""
    for color, width in ((SLIP_EDGE, 5.0), (SLIP, 3.0)):
        scene.circle((x, y), 0.0, stroke=color, width=width, pixels=6.0)


def _turning(scene: Scene, x: float, y: float, ui: float) -> None:
    """Draw the mark of turning."""
    angles, radius = np.linspace(-0.6, 2.6, 16), 9 * ui
    rim = np.array([x, y - radius / 3]) + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    scene.line(rim[:-2], stroke=VELOCITY, width=2.0)
    scene.arrow(rim[-6], rim[-1], fill=VELOCITY, width=2.0)
