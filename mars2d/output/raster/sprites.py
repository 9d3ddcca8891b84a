"""Small pictures of shapes, kept since the next picture needs most of them again."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable

import pygame

__all__ = ["Sprite", "Sprites"]

Sprite = tuple[pygame.Surface, int, int]
"""A small picture, and where its corner lies from the whole pixel that it is drawn at."""


class Sprites:
    """Keeps sprites of at most `pixels` pixels together, the latest used.

    It saves time and changes nothing: one that keeps no pixel makes the same pictures.
    """

    def __init__(self, pixels: int) -> None:
        """Start with none; `pixels` may be 0."""
        self.pixels = pixels
        self.kept = 0
        self._sprites: OrderedDict[Hashable, Sprite] = OrderedDict()

    def __len__(self) -> int:
        """Return how many are kept."""
        return len(self._sprites)

    def get(self, key: Hashable) -> Sprite | None:
        """Return the sprite that looks as `key` says, if it is kept."""
        sprite = self._sprites.get(key)
        if sprite is not None:
            self._sprites.move_to_end(key)
        return sprite

    def keep(self, key: Hashable, sprite: Sprite) -> None:
        """Keep a sprite under a key that has none yet, and forget others for it."""
        self._sprites[key] = sprite
        self.kept += _area(sprite)
        while self.kept > self.pixels:
            self.kept -= _area(self._sprites.popitem(last=False)[1])


def _area(sprite: Sprite) -> int:
    return sprite[0].get_width() * sprite[0].get_height()
