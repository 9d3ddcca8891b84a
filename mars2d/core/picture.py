"""Pictures from files: PNG, read once, and never written to."""

from __future__ import annotations

import os
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mars2d.core.checks import LIMIT
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError
from mars2d.core.pixels import opened_image
from mars2d.core.scene import rgb

__all__ = ["Bounds", "Picture", "Pixels", "image_bounds", "image_file", "read_picture"]

Pixels = NDArray[np.uint8]
Bounds = tuple[float, float, float, float]
"""Where an image lies: (xmin, xmax, ymin, ymax), metres."""


def image_file(name: str, value: object) -> str | None:
    """Check the name of a PNG file that may be None."""
    if value is None:
        return None
    if not isinstance(value, (str, os.PathLike)) or Path(value).suffix.lower() != ".png":
        raise wrong(name, value, "the name of a file that ends in .png, or None")
    return str(value)


def image_bounds(name: str, value: object) -> Bounds | None:
    """Check where an image lies, which may be None."""
    expected = "(xmin, xmax, ymin, ymax) in metres with xmin < xmax and ymin < ymax, or None"
    if value is None:
        return None
    if isinstance(value, (tuple, list, np.ndarray)) and len(value) == 4:
        xmin, xmax, ymin, ymax = (real(f"{name}[{i}]", item) for i, item in enumerate(value))
        far = max(map(abs, (xmin, xmax, ymin, ymax))) > LIMIT
        if xmin < xmax and ymin < ymax and not far:
            return xmin, xmax, ymin, ymax
    raise wrong(name, value, expected)


class Picture:
    """Pixels (rows, columns, 3) that all copies of a part share; they can't be written."""

    def __init__(self, pixels: Pixels) -> None:
        """Take the pixels."""
        pixels.flags.writeable = False
        self.pixels = pixels

    def __deepcopy__(self, memo: object) -> Picture:
        return self

    @cached_property
    def darkness(self) -> NDArray[np.float64]:
        """How dark each pixel is (rows, columns): 1 is black, 0 is white, by Rec. 601's luma."""
        luma = self.pixels @ np.array([299, 587, 114])
        dark = (255_000 - luma) / 255_000
        dark.flags.writeable = False
        return np.asarray(dark)


def read_picture(name: str, image: str, color: str | None = None) -> Picture:
    """Return the picture in a PNG file; where it is transparent `color`, or white, is seen.

    It is read anew only when the file has changed. Raises InputError, beginning with `name`, if the
    file is not there, is no PNG with 8 bits a channel, or is too large.
    """
    path = Path(image)
    return _read(name, path, _version(path), color)


def _read_png(name: str, path: Path) -> Pixels:
    """Return the pixels (rows, columns, 4) of a PNG. Raises InputError, beginning with `name`."""
    name = f"{name} = {str(path)!r}"
    try:
        with opened_image(name, path, "PNG") as image:
            return np.asarray(image.convert("RGBA"))
    except FileNotFoundError:
        where = "" if path.is_absolute() else f" in {Path.cwd()}"
        beside = f"Path(__file__).with_name({path.name!r})"
        raise InputError(
            f"{name}: there is no such file{where}; beside the experiment it is {beside}"
        ) from None


def _version(path: Path) -> tuple[str, int, int]:
    """Return what tells a file from any other, and from itself when it has been changed."""
    try:
        known = path.stat()
        return str(path.absolute()), known.st_mtime_ns, known.st_size
    except (OSError, ValueError):  # it can't be read either, which says why
        return "", 0, 0


@lru_cache(maxsize=4)
def _read(name: str, path: Path, version: tuple[str, int, int], color: str | None) -> Picture:  # noqa: ARG001
    """Return an image over a colour; it is read anew when the file has another version."""
    return Picture(_over(_read_png(name, path), color))


def _over(pixels: Pixels, color: str | None) -> Pixels:
    """Return pixels (rows, columns, 4) laid over a colour, or over white, (rows, columns, 3)."""
    result = pixels[..., :3].copy()
    opacity = pixels[..., 3]
    clear = opacity < 255
    if clear.any():
        share = opacity[clear][:, None] / 255
        beneath = 255 * np.array(rgb(color or "#ffffff"))
        result[clear] = np.round(result[clear] * share + beneath * (1 - share))
    return result
