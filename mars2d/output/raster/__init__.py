"""Pictures drawn with pygame, for files, films and the window."""

import os

from mars2d.core.errors import MissingExtraError

# pygame greets on stdout, where --json promises one line.
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")


def has_pygame() -> bool:
    """Return whether pygame is installed; in a browser, for example, it may be missing."""
    try:
        import pygame  # noqa: F401
    except ImportError:
        return False
    return True


def require_pygame(what: str) -> None:
    """Raise MissingExtraError where pygame is missing; what: the user of it, such as "a film"."""
    if not has_pygame():
        raise MissingExtraError(
            f"{what} needs pygame, which is not installed: pip install pygame-ce"
        )
