"""The colours of the window's own parts, light and dark: calm, so that the robots stand out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.output.raster import shades

__all__ = ["DARK", "LIGHT", "PRINTED", "Theme", "Tone", "contrast", "mixed", "theme_of"]


class Tone(NamedTuple):
    """A colour that means something: as ink, and as the pale plate that the ink is read on."""

    ink: str
    pale: str


@dataclass(frozen=True, slots=True)
class Theme:
    """The colours of everything that is no shape of a scene, and what scenes' colours become.

    page: round the workspace. paper: the workspace itself, on which scenes are drawn. bar: header,
    footer and time bar. plate: what lies over the picture. ink, text, muted: words, by their
    weight. running, waiting, past, hand, error: what the clock does. over, failed: the grounds of
    banners, whose words are `on_banner`.
    """

    dark: bool
    page: str
    paper: str
    bar: str
    plate: str
    veil: str
    edge: str
    grid: str
    grid_axis: str
    ink: str
    text: str
    muted: str
    key: str
    key_edge: str
    track: str
    running: Tone
    waiting: Tone
    past: Tone
    hand: Tone
    error: Tone
    over: str
    failed: str
    on_banner: str
    on_banner_muted: str
    banner_plate: str
    selected: str
    effort: str

    def shade(self, color: str) -> str:
        """Return a scene's colour in this theme, ``#rrggbb`` or ``#rrggbbaa`` as it is given.

        Scenes are made for white paper. On dark paper, neutral colours have their lightness turned
        over, so that black is white and white the paper; vivid ones are as light as can be read.
        """
        return _shaded(color, self.paper) if self.dark else color

    def shade_pixels(self, pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return an image (..., 3 or 4) in this theme, by the same rule; its opacity stays."""
        return shades.on_dark_pixels(pixels, self.paper) if self.dark else pixels


@lru_cache(maxsize=4096)
def _shaded(color: str, paper: str) -> str:
    return shades.on_dark(color[:7], paper) + color[7:]


def mixed(color: str, ground: str, share: float) -> str:
    """Return the colour ``#rrggbb`` of a colour laid over a ground with an opacity from 0 to 1."""
    pairs = ((int(color[k : k + 2], 16), int(ground[k : k + 2], 16)) for k in (1, 3, 5))
    return "#" + "".join(f"{round(g - (g - c) * share):02x}" for c, g in pairs)


def contrast(color: str, ground: str) -> float:
    """Return the contrast of two colours as WCAG 2 defines it: 1 for none, 4.5 to read by, to 21.

    >>> contrast("#000000", "#ffffff")
    21.0
    """
    high, low = sorted((shades.luminance(color), shades.luminance(ground)), reverse=True)
    return (high + 0.05) / (low + 0.05)


LIGHT = Theme(
    dark=False,
    page="#f4f5f7",
    paper="#ffffff",
    bar="#ffffff",
    plate="#ffffff",
    veil="#1f2933",
    edge="#dfe3e8",
    grid="#e9ecef",
    grid_axis="#d5dae0",
    ink="#1f2933",
    text="#3e4c59",
    muted="#5f6c7b",
    key="#f9fafb",
    key_edge="#cbd2d9",
    track="#d5dbe2",
    running=Tone("#0b69a3", "#e3f1fb"),
    waiting=Tone("#8d5a00", "#fdf1d6"),
    past=Tone("#6b3fa0", "#f0e8fa"),
    hand=Tone("#0b6e4f", "#dcf4ea"),
    error=Tone("#a61b1b", "#fbe4e4"),
    over="#243b53",
    failed="#a61b1b",
    on_banner="#ffffff",
    on_banner_muted="#e6ebf0",
    banner_plate="#00000040",
    selected="#0b69a3",
    effort="#8d5a00",
)

PRINTED = replace(LIGHT, muted="#7b8794")
"""Pictures and films: their small print may step back, since they can be enlarged."""

DARK = Theme(
    dark=True,
    page="#14181e",
    paper="#1b2129",
    bar="#1b2129",
    plate="#222a34",
    veil="#07090c",
    edge="#303945",
    grid="#262e38",
    grid_axis="#3a4552",
    ink="#eef2f6",
    text="#c9d2dc",
    muted="#95a2b1",
    key="#303945",
    key_edge="#465362",
    track="#364150",
    running=Tone("#7cc4f7", "#173449"),
    waiting=Tone("#f2c063", "#3d2f12"),
    past=Tone("#c9a9f5", "#33264a"),
    hand=Tone("#6fdcae", "#14392c"),
    error=Tone("#ffa199", "#4c1d1f"),
    over="#2c4b6b",
    failed="#8e2226",
    on_banner="#ffffff",
    on_banner_muted="#e6ebf0",
    banner_plate="#00000059",
    selected="#63b8f5",
    effort="#f2c063",
)


def theme_of(*, dark: bool) -> Theme:
    """Return the theme of a window."""
    return DARK if dark else LIGHT
