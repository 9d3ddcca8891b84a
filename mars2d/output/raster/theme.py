"""Themes, light and dark: the colours of the window's parts, and of scenes on dark paper."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import color_of, rgb


class Tone(NamedTuple):
    """A colour with a meaning: as ink, and as the pale plate below that ink."""

    ink: str
    pale: str


class Theme(NamedTuple):
    """The colours of the window's parts, and the conversion of scenes' colours; by default light.

    page: around the workspace. paper: the workspace, on which scenes are drawn. bar: header, footer
    and time bar. plate: panels over the picture. ink, text, muted: text, by importance. running,
    waiting, past, hand, error: the states of the clock. over, failed: the grounds of banners, with
    text in `on_banner`.
    """

    dark: bool = False
    page: str = "#f4f5f7"
    paper: str = "#ffffff"
    bar: str = "#ffffff"
    plate: str = "#ffffff"
    veil: str = "#1f2933"
    edge: str = "#dfe3e8"
    grid: str = "#e9ecef"
    grid_axis: str = "#d5dae0"
    ink: str = "#1f2933"
    text: str = "#3e4c59"
    muted: str = "#5f6c7b"
    key: str = "#f9fafb"
    key_edge: str = "#cbd2d9"
    track: str = "#d5dbe2"
    running: Tone = Tone("#0b69a3", "#e3f1fb")
    waiting: Tone = Tone("#8d5a00", "#fdf1d6")
    past: Tone = Tone("#6b3fa0", "#f0e8fa")
    hand: Tone = Tone("#0b6e4f", "#dcf4ea")
    error: Tone = Tone("#a61b1b", "#fbe4e4")
    over: str = "#243b53"
    failed: str = "#a61b1b"
    on_banner: str = "#ffffff"
    on_banner_muted: str = "#e6ebf0"
    banner_plate: str = "#00000040"
    selected: str = "#0b69a3"
    effort: str = "#8d5a00"

    def shade(self, color: str) -> str:
        """Return a scene's colour in this theme, ``#rrggbb`` or ``#rrggbbaa`` as it is given.

        Scenes are made for white paper. On dark paper the lightness is inverted: black becomes
        white, and white the paper; the hue stays.
        """
        return _on_dark(color, self.paper) if self.dark else color

    def shade_pixels(self, pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return an image (..., 3 or 4) in this theme, by the same rule; its opacity stays."""
        if not self.dark:
            return pixels
        turned = np.rint(255 * _inverted(pixels[..., :3] / 255, self.paper)).astype(np.uint8)
        return np.concatenate([turned, pixels[..., 3:]], axis=-1)


def mixed(color: str, ground: str, share: float) -> str:
    """Return the colour ``#rrggbb`` of a colour laid over a ground with an opacity from 0 to 1."""
    pairs = ((int(color[k : k + 2], 16), int(ground[k : k + 2], 16)) for k in (1, 3, 5))
    return "#" + "".join(f"{round(g - (g - c) * share):02x}" for c, g in pairs)


@lru_cache(maxsize=4096)
def _on_dark(color: str, paper: str) -> str:
    """Return a colour converted for dark paper: white becomes the paper itself; opacity stays."""
    return color_of(_inverted(np.array(rgb(color)), paper).tolist()) + color[7:]


def _inverted(colors: NDArray[np.float64], paper: str) -> NDArray[np.float64]:
    """Return colours (..., 3), from 0 to 1, of the same hue on paper in place of white."""
    low, high = colors.min(axis=-1, keepdims=True), colors.max(axis=-1, keepdims=True)
    ground = np.array(rgb(paper))
    return np.asarray(ground + (1.0 - ground) * (colors + 1.0 - high - low))


LIGHT = Theme()
PRINTED = Theme(muted="#7b8794")
"""For pictures and films: small text may be paler, since they can be enlarged."""

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
    banner_plate="#00000059",
    selected="#63b8f5",
    effort="#f2c063",
)


def theme_of(*, dark: bool) -> Theme:
    """Return the theme of a window."""
    return DARK if dark else LIGHT
