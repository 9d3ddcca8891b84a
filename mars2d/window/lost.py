"""A display that is lost while a window is open: its server dies, or the way to it is cut.

Xlib then ends the process at once, wherever it is just then, by exit(1): what was recorded would be
gone. So it is asked to go on, and whoever shows pictures asks `check` after each. Xlib before 1.7
can't be asked; where windows are not those of an X server, nothing is done here.
What SDL would do to close its window never ends on a display that is lost: so it is left as it is.
"""

from __future__ import annotations

import atexit
import contextlib
import ctypes
from functools import cache
from typing import Any

import pygame

from mars2d.core.errors import InputError

__all__ = ["DisplayError", "check", "close", "watch"]

LIBRARY = "libX11.so.6"
MOST = 100
"""SDL counts windows from 1; ours is the only one."""

_HANDLER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
_EXIT = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)

_watched: set[int] = set()
_lost: list[int] = []
"""The displays that are lost; there is no way back to another one in the same process."""


class DisplayError(InputError):
    """The display has gone away on which a window was."""


def watch() -> None:
    """Have it noted when the display is lost that a window is on, in place of ending the process.

    Does nothing where there is no X server.
    """
    if pygame.display.get_driver() != "x11":
        return
    with contextlib.suppress(OSError, AttributeError):  # an Xlib older than 1.7
        display = _display()
        if display:
            _exit_by(display, _handlers()[1])
            _watched.add(display)


def check() -> None:
    """Raise DisplayError if the display has gone away."""
    if _lost:
        raise DisplayError("the display has gone away that the window was on")


def close() -> None:
    """End pygame's display, unless it has gone away; where it does so just then, exit."""
    if pygame.display.get_surface() is not None:
        pygame.event.pump()  # which asks whether it is there
    if _lost:
        return
    while _watched:
        _exit_by(_watched.pop(), None)
    pygame.display.quit()


@cache
def _handlers() -> tuple[Any, Any]:
    """Return what Xlib calls to tell of an error and then to exit; all displays share the first.

    They have to stay for as long as the process.
    """
    set_handler = ctypes.CDLL(LIBRARY).XSetIOErrorHandler
    set_handler.argtypes, set_handler.restype = [_HANDLER], _HANDLER

    def note(display: int) -> int:
        if display not in _watched:
            return int(before(display))
        _lost.append(display)
        atexit.unregister(pygame.quit)
        return 0

    def go_on(display: int, _: object) -> None:
        pass

    handler = _HANDLER(note)
    before = set_handler(handler)
    return handler, _EXIT(go_on)


def _exit_by(display: int, function: Any) -> None:
    """Have Xlib call a function where it would exit because of a display; None for exit itself."""
    set_handler = ctypes.CDLL(LIBRARY).XSetIOErrorExitHandler
    set_handler.argtypes, set_handler.restype = [ctypes.c_void_p] * 3, None
    set_handler(display, ctypes.cast(function, ctypes.c_void_p) if function else None, None)


class _Info(ctypes.Structure):
    """SDL_SysWMinfo, of SDL 2: where the X server's window is.

    `pygame.display.get_wm_info` tells it, too, but may crash: it reads more than SDL has written.
    """

    _fields_ = (
        ("version", ctypes.c_uint8 * 3),
        ("system", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("rest", ctypes.c_byte * 120),
    )


def _display() -> int:
    """Return Xlib's pointer to the display of the window. Raises AttributeError without SDL 2."""
    sdl = ctypes.CDLL(pygame.display.__file__)  # which finds all that this is linked with
    sdl.SDL_GetWindowFromID.restype = ctypes.c_void_p
    sdl.SDL_GetWindowWMInfo.argtypes = [ctypes.c_void_p, ctypes.POINTER(_Info)]
    info = _Info(version=pygame.get_sdl_version())
    window = next(filter(None, map(sdl.SDL_GetWindowFromID, range(1, MOST))), None)
    sdl.SDL_GetWindowWMInfo(window, info)
    return info.display or 0
