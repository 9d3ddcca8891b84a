"""What the tests of the window share: a screen, and windows on it."""

from tests.view.person import open_window, screen

__all__ = ["open_window", "screen"]
