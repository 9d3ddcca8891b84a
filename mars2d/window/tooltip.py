"""A word beside the pointer."""

from __future__ import annotations

import pygame

from mars2d.output.raster.painter import Painter

__all__ = ["draw_tooltip"]


def draw_tooltip(
    surface: pygame.Surface, painter: Painter, text: str, foot: tuple[int, int]
) -> pygame.Rect:
    """Draw a word on a plate of its own above a pixel, within the surface; return the plate."""
    ui, theme = painter.ui, painter.theme
    image = painter.fonts.render(text, 13 * ui, theme.ink, bold=True)
    plate = pygame.Rect(0, 0, image.get_width() + round(16 * ui), round(26 * ui))
    plate.midbottom = foot
    plate.clamp_ip(surface.get_rect())
    painter.panel(surface, plate, theme.plate, 6 * ui, theme.key_edge)
    surface.blit(image, image.get_rect(center=plate.center))
    return plate
