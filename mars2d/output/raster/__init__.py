"""The window and the pictures, drawn with pygame."""

import os

from mars2d.core.errors import MissingExtraError

# pygame greets on stdout, where --json promises one line.
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")


def has_pygame() -> bool:
    """Return whether pygame is there: in a browser, for one, it may be missing."""
    try:
        import pygame  # noqa: F401
    except ImportError:
        return False
    return True


def require_pygame(what: str) -> None:
    """Raise MissingExtraError where pygame is missing; what: the thing that needs it: "a film"."""
    if not has_pygame():
        raise MissingExtraError(
            f"{what} needs pygame, which is not installed: pip install pygame-ce"
        )
