"""Themes, light and dark: the colours of the window's parts, and of scenes on dark paper.

Colours of scenes are converted by lightness, chroma and hue. Source: the colour space OKLab,
B. Ottosson (2020), in which equal steps of lightness look equal.
"""

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

        Scenes are made for white paper. On dark paper, the lightness of neutral colours is
        inverted: black becomes white, and white the paper. Vivid colours are lightened to be
        readable.
        """
        return on_dark(color, self.paper) if self.dark else color

    def shade_pixels(self, pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return an image (..., 3 or 4) in this theme, by the same rule; its opacity stays."""
        return on_dark_pixels(pixels, self.paper) if self.dark else pixels


def mixed(color: str, ground: str, share: float) -> str:
    """Return the colour ``#rrggbb`` of a colour laid over a ground with an opacity from 0 to 1."""
    pairs = ((int(color[k : k + 2], 16), int(ground[k : k + 2], 16)) for k in (1, 3, 5))
    return "#" + "".join(f"{round(g - (g - c) * share):02x}" for c, g in pairs)


def contrast(color: str, ground: str) -> float:
    """Return the contrast of two colours as WCAG 2 defines it: 1 for none, 4.5 to read by, to 21.

    >>> contrast("#000000", "#ffffff")
    21.0
    """
    high, low = sorted((luminance(color), luminance(ground)), reverse=True)
    return (high + 0.05) / (low + 0.05)


Float = NDArray[np.float64]

LMS = np.array([
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
])  # fmt: skip
LAB = np.array([
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
])  # fmt: skip
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])

NEUTRAL, VIVID = 0.07, 0.12
"""The chroma up to which a colour is neutral, and from which it is vivid; between, both mix."""
WHITE = 0.96
"""The lightness that black gets."""
GREY = 0.75
"""An exponent below 1 lightens greys, which would be hard to see on dark paper."""
LEVEL, SLOPE = 0.8, 0.45
"""Vivid colours darker than the level are lightened towards it, in the same order."""
BITS = 6
"""The bits per channel in the table that converts images."""


def luminance(color: str) -> float:
    """Return the relative luminance of ``#rrggbb``, from 0 to 1, as WCAG 2 defines it."""
    return float(_linear(np.array(rgb(color))) @ LUMINANCE)


@lru_cache(maxsize=4096)
def on_dark(color: str, paper: str) -> str:
    """Return a colour converted for dark paper: white becomes the paper itself; opacity stays."""
    return color_of(_turned(np.array([rgb(color)]), paper)[0].tolist()) + color[7:]


def on_dark_pixels(pixels: NDArray[np.uint8], paper: str) -> NDArray[np.uint8]:
    """Return pixels (..., 3 or 4) converted for dark paper; their opacity is kept."""
    red, green, blue = (pixels[..., k].astype(np.intp) >> (8 - BITS) for k in range(3))
    turned = _table(paper)[(red << 2 * BITS) | (green << BITS) | blue]
    return np.concatenate([turned, pixels[..., 3:]], axis=-1)


@lru_cache(maxsize=2)
def _table(paper: str) -> NDArray[np.uint8]:
    """Return the conversions of all colours with `BITS` bits per channel, (colours, 3)."""
    levels = np.linspace(0.0, 1.0, 1 << BITS)
    grid = np.meshgrid(levels, levels, levels, indexing="ij")
    colors = np.stack(grid, axis=-1).reshape(-1, 3)
    return np.asarray(np.rint(255 * _turned(colors, paper)).astype(np.uint8))


def _turned(colors: Float, paper: str) -> Float:
    """Return colours (k, 3), from 0 to 1, converted for dark paper."""
    lab, ground = _lab(colors), _lab(np.array(rgb(paper)))
    light, chroma = lab[:, :1], np.hypot(lab[:, 1:2], lab[:, 2:])
    vivid = np.clip((chroma - NEUTRAL) / (VIVID - NEUTRAL), 0.0, 1.0)
    over = ground[0] + np.clip(1 - light, 0.0, 1.0) ** GREY * (WHITE - ground[0])
    lifted = np.maximum(light, LEVEL - SLOPE * (LEVEL - light))
    tint = (1 - vivid) * light * ground[1:]
    return _colors(np.hstack([over + vivid * (lifted - over), lab[:, 1:] + tint]))


def _linear(colors: Float) -> Float:
    """Return the light that sRGB values stand for."""
    return np.where(colors <= 0.04045, colors / 12.92, ((colors + 0.055) / 1.055) ** 2.4)


def _lab(colors: Float) -> Float:
    """Return lightness, green to red and blue to yellow (..., 3) of sRGB values (..., 3)."""
    return np.asarray(np.cbrt(_linear(colors) @ LMS.T) @ LAB.T)


def _colors(lab: Float) -> Float:
    """Return the sRGB values of values of `_lab`, clipped to those of a screen."""
    light = np.linalg.solve(LMS, np.linalg.solve(LAB, lab.T) ** 3).T
    light = np.clip(light, 0.0, 1.0)
    bright = 1.055 * np.maximum(light, 0.0031308) ** (1 / 2.4) - 0.055
    return np.where(light <= 0.0031308, 12.92 * light, bright)


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
