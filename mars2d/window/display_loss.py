"""Detects that the X display is lost while a window is open: its server or connection has gone.

Xlib would then end the process at once with exit(1), and the recorded run would be lost. This
module asks Xlib to go on instead; whoever shows pictures calls `check` after each. It needs Xlib
1.7, and does nothing on other display systems. SDL's own closing of a window never returns on a
lost display, so the window is left open.
"""

from __future__ import annotations

import atexit
import contextlib
import ctypes
from functools import cache
from typing import Any

import pygame

from mars2d.core.errors import InputError

LIBRARY = "libX11.so.6"
MAX_WINDOW = 100
"""The highest window number that is tried; SDL counts from 1, and ours is the only window."""

_HANDLER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
_EXIT = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)

_watched: set[int] = set()
_lost: list[int] = []
"""The displays that are lost; the process can't open another one."""


class DisplayError(InputError):
    """The display of a window has gone away."""


def watch() -> None:
    """Watch the window's display: losing it no longer ends the process.

    Does nothing without an X server.
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
    """End pygame's display unless it is lost; if it is lost during that, the process exits."""
    if pygame.display.get_surface() is not None:
        pygame.event.pump()  # which finds out whether it is lost
    if _lost:
        return
    while _watched:
        _exit_by(_watched.pop(), None)
    pygame.display.quit()


@cache
def _handlers() -> tuple[Any, Any]:
    """Return the handlers that Xlib calls on an error and then to exit.

    All displays share the first. Both must live as long as the process.
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
    """Set the function that Xlib calls in place of exiting when a display is lost; None: exit."""
    set_handler = ctypes.CDLL(LIBRARY).XSetIOErrorExitHandler
    set_handler.argtypes, set_handler.restype = [ctypes.c_void_p] * 3, None
    set_handler(display, ctypes.cast(function, ctypes.c_void_p) if function else None, None)


class _Info(ctypes.Structure):
    """SDL 2's SDL_SysWMinfo, which holds the X server's window.

    `pygame.display.get_wm_info` may crash, because it reads more than SDL has written.
    """

    _fields_ = (
        ("version", ctypes.c_uint8 * 3),
        ("system", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("rest", ctypes.c_byte * 120),
    )


def _display() -> int:
    """Return Xlib's pointer to the display of the window. Raises AttributeError without SDL 2."""
    sdl = ctypes.CDLL(pygame.display.__file__)  # finds the SDL that it is linked to
    sdl.SDL_GetWindowFromID.restype = ctypes.c_void_p
    sdl.SDL_GetWindowWMInfo.argtypes = [ctypes.c_void_p, ctypes.POINTER(_Info)]
    info = _Info(version=pygame.get_sdl_version())
    window = next(filter(None, map(sdl.SDL_GetWindowFromID, range(1, MAX_WINDOW))), None)
    sdl.SDL_GetWindowWMInfo(window, info)
    return info.display or 0
