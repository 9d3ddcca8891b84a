"""The colours of the window's own parts: calm, so that the robots stand out."""

from __future__ import annotations

PAGE = "#f4f5f7"
BAR = "#ffffff"
EDGE = "#dfe3e8"
GRID = "#e9ecef"
GRID_AXIS = "#d5dae0"
INK = "#1f2933"
TEXT = "#3e4c59"
MUTED = "#7b8794"
RUNNING = "#0b69a3"
RUNNING_PALE = "#e3f1fb"
WAITING = "#8d5a00"
WAITING_PALE = "#fdf1d6"
OVER = "#243b53"
ERROR = "#a61b1b"
ERROR_PALE = "#fbe4e4"
