"""What the tests of the window share: windows and editors, an X server, experiments."""

import pygame
import pytest

from tests.processes import x_server
from tests.window.person import display, open_editor, open_window, pushing, room

__all__ = ["display", "open_editor", "open_window", "pushing", "room", "screen"]


@pytest.fixture(scope="session")
def screen():
    """Start an X server on a free display and return its name."""
    with x_server() as (name, _):
        yield name


@pytest.fixture
def keyboard():
    """Start pygame's display, without which keys have no names."""
    pygame.display.init()
