"""Is there a screen?"""

from __future__ import annotations

import os
import sys
import time

import pygame

from mars2d.errors import InputError
from mars2d.view.desktop import be_sharp

__all__ = ["NO_DISPLAY", "be_quick", "display_available", "open_display"]

NO_DISPLAY = (
    "there is no display for a window; run it with --headless, draw a picture with "
    "--figure OUT.png, or make a film with --video OUT.gif"
)

NOT_REAL = ("dummy", "offscreen", "evdev", "disk")
ATTEMPTS = 3


def display_available() -> bool:
    """Return whether a window could be opened that a person sees."""
    wanted = os.environ.get("SDL_VIDEODRIVER") or os.environ.get("SDL_VIDEO_DRIVER") or ""
    if wanted.lower() in NOT_REAL:
        return False
    if pygame.display.get_init():
        return pygame.display.get_driver() not in NOT_REAL
    if sys.platform in ("win32", "darwin", "cygwin", "emscripten"):
        return True
    if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return False
    # The variable may name a screen that is gone, as after a lost ssh connection: try.
    try:
        open_display()
    except InputError:
        return False
    pygame.display.quit()
    return True


def open_display() -> None:
    """Start pygame's display. Raises InputError where there is none that a person sees."""
    if pygame.display.get_init():
        if pygame.display.get_driver() in NOT_REAL:
            raise InputError(NO_DISPLAY)
        return
    be_sharp()
    be_quick()
    for attempt in range(ATTEMPTS):
        try:
            pygame.display.init()
        except pygame.error:
            # A bare X server starts anew when its last window has closed, and is deaf meanwhile.
            if attempt + 1 < ATTEMPTS and os.environ.get("DISPLAY"):
                time.sleep(0.1)
            continue
        if pygame.display.get_driver() not in NOT_REAL:
            return
        pygame.display.quit()
        break
    raise InputError(NO_DISPLAY)


def be_quick() -> None:
    """Ask for pictures to go to the screen as they are; to be called before the display starts.

    SDL would hand them to OpenGL, which takes ten times as long where that is done in software.
    """
    os.environ.setdefault("SDL_FRAMEBUFFER_ACCELERATION", "0")
