"""The clipboard of the desktop."""

from __future__ import annotations

import pygame


def copied(text: str) -> bool:
    """Copy text to the clipboard; return whether that worked."""
    if not pygame.display.get_init() or pygame.display.get_surface() is None:
        return False
    try:
        pygame.scrap.put_text(text)
    except pygame.error:
        return False
    return pasted() == text


def pasted() -> str:
    """Return the text on the clipboard, "" if there is none or it can't be reached."""
    try:
        return pygame.scrap.get_text()
    except pygame.error:
        return ""
