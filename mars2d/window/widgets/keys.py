"""Keys that modify others."""

from __future__ import annotations

import pygame

CONTROL = pygame.KMOD_CTRL | pygame.KMOD_META

MODIFIERS = frozenset(
    f"{side} {key}" for side in ("left", "right") for key in ("shift", "ctrl", "alt", "meta", "gui")
) | {"caps lock", "numlock", "scroll lock", "alt gr", "menu", "print screen", ""}
"""Keys that only modify other keys."""
