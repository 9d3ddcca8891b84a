"""The legend of the forces, in a corner of the picture."""

from __future__ import annotations

import pygame

from mars2d.forces import FORCE, SLIP, SLIP_EDGE, force_scale, in_newtons, round_force
from mars2d.scenario import Scenario
from mars2d.scene import Scene, faded
from mars2d.view.camera import Camera
from mars2d.view.painter import Painter

__all__ = ["draw_legend"]

LONGEST = 72.0
"""Of its arrow, points; the forces are of 1, 2, 5, 10 ... newtons."""

SMALLEST = 300.0
"""The height of a picture with a legend, points, at least."""


def draw_legend(
    surface: pygame.Surface,
    painter: Painter,
    scenario: Scenario,
    camera: Camera,
    plot: pygame.Rect,
) -> None:
    """Draw an arrow of a round force as long as it is now, and the mark of a drive that slips."""
    ui, theme = painter.ui, painter.theme
    if plot.height < SMALLEST * ui or plot.width < 2 * SMALLEST * ui:
        return
    scale = force_scale(scenario)
    pixels = scale.newton * camera.scale
    force = round_force(LONGEST * ui / pixels)
    length = force * pixels
    size, pad, row = 13 * ui, 10 * ui, 24 * ui
    words = (in_newtons(force), "slips")
    column = max(length, 18 * ui)
    width = pad + column + 8 * ui + max(painter.fonts.width(w, size) for w in words) + pad
    plate = pygame.Rect(0, 0, round(width), round(2 * row + 8 * ui))
    plate.bottomleft = (plot.left + round(8 * ui), plot.bottom - round(8 * ui))
    painter.panel(surface, plate, faded(theme.plate, 0.9), 8 * ui, theme.edge)
    left, middle = plate.left + pad, plate.top + 4 * ui + row / 2
    scene = Scene()
    scene.arrow((left, -middle), (left + length, -middle), fill=FORCE, width=scale.width)
    ring = (left + column / 2, -middle - row)
    for color, line in ((SLIP_EDGE, 5.0), (SLIP, 3.0)):
        scene.circle(ring, 0.0, stroke=color, width=line, pixels=6.0)
    painter.paint(surface, scene.shapes, Camera(1.0, 0.0, 0.0))
    for k, word in enumerate(words):
        image = painter.fonts.render(word, size, theme.text)
        place = image.get_rect(midleft=(round(left + column + 8 * ui), round(middle + k * row)))
        surface.blit(image, place)
