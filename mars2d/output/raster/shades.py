"""How colours made for white paper look on dark paper: by lightness, chroma and hue.

Source: the colour space OKLab, B. Ottosson (2020), in which equal steps of lightness look equal.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

__all__ = ["luminance", "on_dark", "on_dark_pixels"]

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
"""The chroma up to which a colour is neutral, and from which it is vivid; between, some of both."""
WHITE = 0.96
"""The lightness that black gets."""
GREY = 0.75
"""Below 1, so that grey is nearer to white: on dark paper it would else be hard to see."""
LEVEL, SLOPE = 0.8, 0.45
"""Vivid colours that are darker than the level come near it, and keep their order."""
BITS = 6
"""The bits a channel of the table by which images are turned."""


def luminance(color: str) -> float:
    """Return the relative luminance of ``#rrggbb``, from 0 to 1, as WCAG 2 defines it."""
    return float(_linear(_numbers(color)) @ LUMINANCE)


def on_dark(color: str, paper: str) -> str:
    """Return what ``#rrggbb`` becomes on dark paper: white becomes the paper itself."""
    turned = np.rint(255 * _turned(_numbers(color)[None], paper))[0]
    return "#" + "".join(f"{int(value):02x}" for value in turned)


def on_dark_pixels(pixels: NDArray[np.uint8], paper: str) -> NDArray[np.uint8]:
    """Return what pixels (..., 3 or 4) become; a fourth number, the opacity, is kept."""
    red, green, blue = (pixels[..., k].astype(np.intp) >> (8 - BITS) for k in range(3))
    turned = _table(paper)[(red << 2 * BITS) | (green << BITS) | blue]
    return np.concatenate([turned, pixels[..., 3:]], axis=-1)


@lru_cache(maxsize=2)
def _table(paper: str) -> NDArray[np.uint8]:
    """Return what each colour becomes whose channels have `BITS` bits, (colours, 3)."""
    levels = np.linspace(0.0, 1.0, 1 << BITS)
    grid = np.meshgrid(levels, levels, levels, indexing="ij")
    colors = np.stack(grid, axis=-1).reshape(-1, 3)
    return np.asarray(np.rint(255 * _turned(colors, paper)).astype(np.uint8))


def _turned(colors: Float, paper: str) -> Float:
    """Return what colours (k, 3) become, from 0 to 1."""
    lab, ground = _lab(colors), _lab(_numbers(paper))
    light, chroma = lab[:, :1], np.hypot(lab[:, 1:2], lab[:, 2:])
    vivid = np.clip((chroma - NEUTRAL) / (VIVID - NEUTRAL), 0.0, 1.0)
    over = ground[0] + np.clip(1 - light, 0.0, 1.0) ** GREY * (WHITE - ground[0])
    lifted = np.maximum(light, LEVEL - SLOPE * (LEVEL - light))
    tint = (1 - vivid) * light * ground[1:]
    return _colors(np.hstack([over + vivid * (lifted - over), lab[:, 1:] + tint]))


def _numbers(color: str) -> Float:
    return np.array([int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)])


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
