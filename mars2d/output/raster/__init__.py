"""Pictures drawn with pygame, for files, films and the window."""

import os

from mars2d.core.errors import MissingExtraError

# pygame greets on stdout, where --json promises one line.
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")

ONLY_CE = "pip uninstall --yes pygame pygame-ce && pip install pygame-ce"
"""What to do where pygame lies over pygame-ce, or beside it."""


def has_pygame() -> bool:
    """Return whether pygame-ce is installed; in a browser, for example, it may be missing.

    Raises MissingExtraError where pygame, which lacks what we use, lies in its place.
    """
    try:
        import pygame
    except ImportError:
        return False
    if not getattr(pygame, "IS_CE", False):
        raise MissingExtraError(
            f"pygame {pygame.version.ver} has been installed over pygame-ce: {ONLY_CE}"
        )
    return True


def require_pygame(what: str) -> None:
    """Raise MissingExtraError where pygame-ce is missing; what: its user, such as "a film"."""
    if not has_pygame():
        raise MissingExtraError(
            f"{what} needs pygame, which is not installed: pip install pygame-ce"
        )
