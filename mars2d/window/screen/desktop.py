"""The scale of the desktop: how many pixels a point has."""

from __future__ import annotations

import ctypes
import os
import sys

import pygame

from mars2d.core.errors import InputError, shown

VARIABLE = "MARS2D_SCALE"
"""The environment variable that sets the number of pixels in a point."""
MIN_SCALE, MAX_SCALE = 0.5, 8.0
USUAL_DPI = 96.0
MAX_SHARE = 0.9
"""The largest share of the desktop that a new window takes."""


def desktop_scale() -> float:
    """Return how many pixels a point of the desktop has: 1, or 1.25 to 4 on sharp screens.

    The environment variable MARS2D_SCALE, 0.5 to 8, overrides it. It is 1 on systems that enlarge
    windows themselves, such as macOS and Wayland, and on X servers. Raises InputError for an
    invalid variable.
    """
    chosen = os.environ.get(VARIABLE)
    if chosen:
        try:
            scale = float(chosen)
        except ValueError:
            scale = float("nan")
        if MIN_SCALE <= scale <= MAX_SCALE:
            return scale
        expected = f"expected the pixels of a point, {MIN_SCALE:g} to {MAX_SCALE:g}"
        raise InputError(f"{VARIABLE}={shown(chosen)}: {expected}")
    driver = pygame.display.get_driver() if pygame.display.get_init() else ""
    found = _of_windows() if driver == "windows" else None
    return min(max(found, 1.0), MAX_SCALE) if found else 1.0


def opening_size(size: tuple[int, int], scale: float) -> tuple[int, int]:
    """Return the size in pixels of a window of `size` points, reduced to fit the desktop.

    The scale is reduced to no less than 1; then each side is bounded by itself. The display must
    have been started.
    """
    width, height = (MAX_SHARE * room for room in pygame.display.get_desktop_sizes()[0])
    share = min(scale, max(1.0, min(width / size[0], height / size[1])))
    return round(min(share * size[0], width)), round(min(share * size[1], height))


def _of_windows() -> float | None:
    if sys.platform != "win32":
        return None
    try:
        return float(ctypes.windll.user32.GetDpiForSystem()) / USUAL_DPI
    except (AttributeError, OSError):  # before Windows 10
        return None
