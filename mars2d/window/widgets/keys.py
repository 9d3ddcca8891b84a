"""A key of a window: the command that it gives, its names, and its line of help."""

from __future__ import annotations

from dataclasses import dataclass

import pygame

CONTROL = pygame.KMOD_CTRL | pygame.KMOD_META

MODIFIERS = frozenset(
    f"{side} {key}" for side in ("left", "right") for key in ("shift", "ctrl", "alt", "meta", "gui")
) | {"caps lock", "numlock", "scroll lock", "alt gr", "menu", "print screen", ""}
"""Keys that only modify other keys."""


@dataclass(frozen=True, slots=True)
class Key:
    """A command, the keys that give it, by pygame's names, and its line of help.

    labels: as on the keyboard. repeats: whether a held key repeats the command.
    """

    action: str
    names: tuple[str, ...]
    labels: tuple[str, ...]
    help: str
    repeats: bool = False


def chord(code: int, modifiers: int) -> str:
    """Return the name of a key with its modifiers, for example ``ctrl+shift+z``."""
    parts = []
    if modifiers & CONTROL:
        parts.append("ctrl")
    if modifiers & pygame.KMOD_SHIFT:
        parts.append("shift")
    return "+".join([*parts, pygame.key.name(code)])
