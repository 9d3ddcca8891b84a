"""What may be switched on over the picture: names, and links to neighbours."""

from __future__ import annotations

from collections.abc import Hashable

import numpy as np
import pygame

from mars2d.core.scene import Scene, Text
from mars2d.core.usercode import called
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import mixed
from mars2d.record.frame import Frame
from mars2d.scenario.neighbours import Everyone

__all__ = ["Labels", "Links"]

MOST = 600
"""Of the links between neighbours, so many are drawn: the first ones."""

FAINT = 0.55
"""The opacity of links."""

KEPT = 2000
"""So many labels are kept."""


class Labels:
    """Draws many texts with halos quickly: each is put together once."""

    def __init__(self) -> None:
        """Start with none kept."""
        self._images: dict[Hashable, pygame.Surface] = {}

    def draw(self, surface: pygame.Surface, painter: Painter, scene: Scene, camera: Camera) -> None:
        """Draw the texts of a scene, of one line each and anchored above their points."""
        gap, images = 4 * painter.ui - _reach(painter), []
        for shape in scene.shapes:
            if isinstance(shape, Text):
                image = self._image(painter, shape)
                x = camera.x + camera.scale * shape.position[0] - image.get_width() / 2
                y = camera.y - camera.scale * shape.position[1] - gap - image.get_height()
                images.append((image, (round(x), round(y))))
        surface.fblits(images)

    def _image(self, painter: Painter, shape: Text) -> pygame.Surface:
        """Return a text with its halo."""
        theme, size = painter.theme, shape.size * painter.ui
        key = shape.text, shape.color, shape.halo, size, theme
        image = self._images.get(key)
        if image is None:
            if len(self._images) >= KEPT:
                self._images.clear()
            text = painter.fonts.render(shape.text, size, theme.shade(shape.color))
            reach = _reach(painter)
            image = pygame.Surface(
                text.get_rect().inflate(2 * reach, 2 * reach).size, pygame.SRCALPHA
            )
            if shape.halo:
                halo = theme.shade(shape.halo)
                image.fill((*rgba(halo)[:3], 0))
                rim = painter.fonts.render(shape.text, size, halo)
                steps = 0, reach, 2 * reach
                image.fblits((rim, (dx, dy)) for dx in steps for dy in steps)
            image.blit(text, (reach, reach))
            self._images[key] = image
        return image


def _reach(painter: Painter) -> int:
    """Return how wide a halo is, pixels."""
    return max(1, round(1.5 * painter.ui))


class Links:
    """Draws a line between neighbours, unless all robots are neighbours of each other.

    Who is whose neighbour is asked once a control step.
    """

    def __init__(self) -> None:
        """Start with nothing asked."""
        self._asked: tuple[object, ...] = ()
        self._pairs = np.empty((0, 2), dtype=int)

    def draw(self, surface: pygame.Surface, painter: Painter, frame: Frame, camera: Camera) -> None:
        """Draw the links of a frame."""
        pairs = self._pairs_of(frame)
        if not len(pairs):
            return
        theme = painter.theme
        ink = mixed(theme.muted, theme.paper, FAINT)
        places = camera.to_pixels(frame.pose[:2].T)
        for start, end in zip(
            places[pairs[:, 0]].tolist(), places[pairs[:, 1]].tolist(), strict=True
        ):
            pygame.draw.aaline(surface, ink, start, end)

    def _pairs_of(self, frame: Frame) -> np.ndarray[tuple[int, ...], np.dtype[np.int_]]:
        """Return the pairs (k, 2) that are linked."""
        rule = frame.scenario.neighbours
        asked = frame.scenario, len(frame.path), rule.fixed
        if self._asked[:1] == asked[:1] and (rule.fixed or self._asked == asked):
            return self._pairs
        self._asked = asked
        pairs: set[tuple[int, int]] = set()
        if not isinstance(rule, Everyone):
            position = frame.pose[:2] if frame.sensed is None else frame.sensed[:2]
            with called("Scenario.neighbours", rule.of):
                found = rule.of(position)
            pairs = {(min(i, j), max(i, j)) for i, row in enumerate(found) for j in row}
        self._pairs = np.array(sorted(pairs)[:MOST], dtype=int).reshape(-1, 2)
        return self._pairs
