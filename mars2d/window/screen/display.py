"""The display: whether there is one, how a window is opened on it, and how that looks."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from mars2d.core.description import Description, flag, number
from mars2d.core.errors import InputError
from mars2d.core.scene import PALETTE, Scene
from mars2d.output.raster import has_pygame

if TYPE_CHECKING:
    import pygame

    from mars2d.output.raster.painter import Painter

NO_DISPLAY = (
    "there is no display for a window; run it with --headless, draw a picture with "
    "--figure OUT.png, or make a film with --video OUT.gif"
)

NOT_REAL = ("dummy", "offscreen", "evdev", "disk")
"""SDL's video drivers without a screen."""

_tried: list[bool] = []
"""Whether the display was started only to see whether it can be."""

PICTURES_A_SECOND = 60
"""How often a window is drawn."""
REPEAT_DELAY, REPEAT_INTERVAL = 400, 60
"""The time until a held key repeats, and between repeats, milliseconds."""


class Preferences(Description):
    """How a window looks at first, whatever the experiment; keys change it."""

    dark: bool = flag(default=False, doc="for a dark room, else for a projector in daylight")
    text: float = number(default=1.0, low=0.5, high=4, doc="factor on the size of text and lines")


def display_available() -> bool:
    """Return whether a window can be opened on a real screen."""
    named = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    if not has_pygame() or (sys.platform == "linux" and not named):
        return False
    import pygame

    ours = not pygame.display.get_init()
    try:
        open_display()  # what is named may be gone, for example after a lost ssh connection
    except InputError:
        return False
    if ours:
        _tried.append(True)  # the window takes it over: to start it twice takes long
    return True


def open_display() -> None:
    """Start pygame's display. Raises InputError without a real screen."""
    import pygame

    if pygame.display.get_init():
        if pygame.display.get_driver() in NOT_REAL:
            raise InputError(NO_DISPLAY)
        return
    # On Windows the desktop enlarges no pixels; elsewhere, OpenGL in software takes ten times as
    # long as to copy pictures to the screen.
    os.environ.setdefault("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")
    os.environ.setdefault("SDL_FRAMEBUFFER_ACCELERATION", "0")
    with suppress(pygame.error):
        pygame.display.init()
        if pygame.display.get_driver() not in NOT_REAL:
            return
        pygame.display.quit()
    raise InputError(NO_DISPLAY)


@contextmanager
def started_display() -> Iterator[None]:
    """Start pygame's display, and end it afterwards unless it was started before.

    Keys pressed while one window made way for the next one are forgotten.
    Raises InputError without a real screen.
    """
    import pygame

    ours = not pygame.display.get_init() or bool(_tried)
    _tried.clear()
    open_display()
    pygame.event.clear((pygame.KEYDOWN, pygame.TEXTINPUT))
    try:
        yield
    finally:
        if ours:
            pygame.display.quit()


def open_window(size: tuple[int, int], painter: Painter) -> pygame.Surface:
    """Open a window of `size` pixels, in which held keys repeat, and return its surface.

    painter: draws the window's icon. Raises InputError if the window can't be opened.
    """
    import pygame

    pygame.display.set_icon(_icon(painter))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # desktops may choose another size
            surface = pygame.display.set_mode(size, pygame.RESIZABLE)
    except pygame.error as error:
        raise InputError(f"the window can't be opened ({error}): {NO_DISPLAY}") from None
    pygame.key.set_repeat(REPEAT_DELAY, REPEAT_INTERVAL)
    return surface


def _icon(painter: Painter) -> pygame.Surface:
    """Return the icon of MARS2D's windows: a robot, seen from above."""
    import pygame

    from mars2d.output.raster.camera import Camera

    scene = Scene()
    scene.circle((0, 0), 1.0, fill=PALETTE[0], stroke="#ffffff", width=2.0)
    scene.line([(0, 0), (1, 0)], stroke="#ffffff", width=7.0)
    surface = pygame.Surface((64, 64), pygame.SRCALPHA, 32)
    painter.paint(surface, scene.shapes, Camera(29.0, 32.0, 32.0), shaded=False)
    return surface
