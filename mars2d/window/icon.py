"""The icon of MARS2D's windows."""

from __future__ import annotations

import pygame

from mars2d.core.scene import PALETTE, Scene
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter

__all__ = ["icon"]


def icon(painter: Painter) -> pygame.Surface:
    """Return it: a robot, seen from above."""
    scene = Scene()
    scene.circle((0, 0), 1.0, fill=PALETTE[0], stroke="#ffffff", width=2.0)
    scene.line([(0, 0), (1, 0)], stroke="#ffffff", width=7.0)
    surface = pygame.Surface((64, 64), pygame.SRCALPHA, 32)
    painter.paint(surface, scene.shapes, Camera(29.0, 32.0, 32.0), shaded=False)
    return surface
