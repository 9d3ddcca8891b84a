"""How well colours can be told apart."""

import numpy as np

from mars2d.core.scene import rgb

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def luminance(color):
    """Return the relative luminance of ``#rrggbb``, from 0 to 1, as WCAG 2 defines it."""
    values = np.array(rgb(color))
    light = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
    return float(light @ LUMINANCE)


def contrast(color, ground):
    """Return the contrast of two colours as WCAG 2 defines it, from 1 to 21."""
    high, low = sorted((luminance(color), luminance(ground)), reverse=True)
    return (high + 0.05) / (low + 0.05)
