"""How large a point is on this desktop: sharp screens have several pixels for one."""

from __future__ import annotations

import ctypes
import os
import re
import sys

import pygame

from mars2d.core.errors import InputError, shown

__all__ = ["VARIABLE", "be_sharp", "desktop_scale", "opening_size"]

VARIABLE = "MARS2D_SCALE"
"""The environment variable that says how many pixels a point has, where that is not found out."""
LEAST, MOST = 0.5, 8.0
USUAL_DPI = 96.0
ROOM = 0.9
"""A window that opens takes at most such a share of the desktop."""


def be_sharp() -> None:
    """Ask Windows not to enlarge the window's pixels; to be called before the display starts."""
    os.environ.setdefault("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")


def desktop_scale() -> float:
    """Return how many pixels a point of the desktop has: 1, on sharp screens 1.25 to 4.

    The variable MARS2D_SCALE decides if it is set, and must be 0.5 to 8. Where the system enlarges
    windows by itself, as on macOS and Wayland, it is 1. Raises InputError.
    """
    chosen = os.environ.get(VARIABLE)
    if chosen:
        return _chosen(chosen)
    driver = pygame.display.get_driver() if pygame.display.get_init() else ""
    found = {"windows": _of_windows, "x11": _of_x11}.get(driver, lambda: None)()
    return min(max(found, 1.0), MOST) if found else 1.0


def opening_size(size: tuple[int, int], scale: float) -> tuple[int, int]:
    """Return the pixels of a window of `size` points; less where the desktop has not as many.

    A desktop too small even at a scale of 1 bounds each side by itself. The display must have been
    started.
    """
    width, height = (ROOM * room for room in pygame.display.get_desktop_sizes()[0])
    share = min(scale, max(1.0, min(width / size[0], height / size[1])))
    return round(min(share * size[0], width)), round(min(share * size[1], height))


def _chosen(text: str) -> float:
    try:
        scale = float(text)
    except ValueError:
        scale = float("nan")
    if not LEAST <= scale <= MOST:
        raise InputError(
            f"{VARIABLE}={shown(text)}: expected the pixels of a point, {LEAST:g} to {MOST:g}"
        )
    return scale


def _of_windows() -> float | None:
    if sys.platform != "win32":
        return None
    try:
        return float(ctypes.windll.user32.GetDpiForSystem()) / USUAL_DPI
    except (AttributeError, OSError):  # before Windows 10
        return None


def _of_x11() -> float | None:
    """Return what the desktop has set for its programs: GDK_SCALE, or the resource Xft.dpi."""
    try:
        return float(os.environ["GDK_SCALE"])
    except (KeyError, ValueError):
        found = re.search(r"^Xft\.dpi:\s*([\d.]+)\s*$", _resources(), re.MULTILINE)
        return float(found[1]) / USUAL_DPI if found else None


def _resources() -> str:
    """Return the resources of the X server, lines of names and values; empty without one."""
    try:
        x11 = ctypes.CDLL("libX11.so.6")
    except OSError:
        return ""
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XOpenDisplay.argtypes = [ctypes.c_char_p]
    x11.XResourceManagerString.restype = ctypes.c_char_p
    x11.XResourceManagerString.argtypes = [ctypes.c_void_p]
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display = x11.XOpenDisplay(None)
    if not display:
        return ""
    try:
        return (x11.XResourceManagerString(display) or b"").decode("latin-1")
    finally:
        x11.XCloseDisplay(display)
