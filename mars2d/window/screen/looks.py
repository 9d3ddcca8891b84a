"""The looks of a window: its colours, the size of its text, full screen."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Literal

import pygame

from mars2d.output.raster.layout import FOOTER, Layout, next_text_size
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import theme_of
from mars2d.window.screen.desktop import desktop_scale, opening_size
from mars2d.window.screen.display import Preferences, open_window

Say = Callable[[str, Literal["info", "warning"]], None]


class Looks:
    """How a window looks, which keys and buttons change.

    say: shows a text of a kind, "info" or "warning".

    painter: draws all that is seen. text: a factor on the size of text and lines. scale: the
    desktop's scaling factor. actions: the commands that change the looks, by name.
    """

    def __init__(self, preferences: Preferences | None = None, say: Say | None = None) -> None:
        """Start with these preferences; the scale is 1 until the window opens."""
        wanted, self._say = preferences or Preferences(), say or (lambda _text, _kind: None)
        self.painter = Painter(theme=theme_of(dark=wanted.dark))
        self.text, self.scale = wanted.text, 1.0
        self.actions: dict[str, Callable[[], None]] = {
            "dark": self._change_theme,
            "text": self._change_text,
            "screen": self._fill_screen,
        }

    @property
    def preferences(self) -> Preferences:
        """The preferences for another window that looks the same."""
        return Preferences(dark=self.painter.theme.dark, text=self.text)

    def is_on(self, action: str) -> bool:
        """Return whether the setting that an action switches is on."""
        if action == "screen":
            return pygame.display.get_surface() is not None and pygame.display.is_fullscreen()
        return action == "dark" and self.painter.theme.dark

    def open(self, size: tuple[int, int]) -> pygame.Surface:
        """Open a window of `size` points, and return its surface; one that is open keeps its size.

        Raises InputError if the window can't be opened.
        """
        self.scale, now = desktop_scale(), pygame.display.get_surface()
        pixels = opening_size(size, self.scale) if now is None else now.get_size()
        return open_window(pixels, self.painter)

    def layout(
        self, size: tuple[int, int], footer_height: float = FOOTER, *, controls: bool = False
    ) -> Layout:
        """Return the layout of a surface of `size` pixels. The rest is as for `Layout.of`."""
        return Layout.of(size, footer_height, text=self.text, scale=self.scale, controls=controls)

    def points(self, size: tuple[int, int]) -> tuple[int, int]:
        """Return a size in points, given in pixels."""
        return round(size[0] / self.scale), round(size[1] / self.scale)

    def remembered(self, size: tuple[int, int]) -> dict[str, object]:
        """Return the looks of a window of `size` pixels, to be kept in the memory."""
        return {"size": self.points(size), "dark": self.painter.theme.dark, "text": self.text}

    def _change_theme(self) -> None:
        self.painter.theme = theme_of(dark=not self.painter.theme.dark)

    def _change_text(self) -> None:
        """Choose the next size of text, after the largest the smallest."""
        self.text = next_text_size(self.text)
        self._say(f"text {self.text:g} times as large as usual", "info")

    def _fill_screen(self) -> None:
        """Fill the screen with the window, or no longer."""
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)  # the window may be made anew
                pygame.display.toggle_fullscreen()
        except pygame.error as error:
            self._say(f"no full screen here: {error}", "warning")
