"""What the tests of the window share: a screen, windows on it, an experiment."""

from tests.window.drawing import open_editor
from tests.window.person import open_window, pushing, repeating_screen, room, screen

__all__ = ["open_editor", "open_window", "pushing", "repeating_screen", "room", "screen"]
