"""What the tests of the window share: a screen, windows on it, an experiment."""

from tests.window.person import open_window, pushing, room, screen

__all__ = ["open_window", "pushing", "room", "screen"]
