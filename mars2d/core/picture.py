"""Image files, opened within limits, and the pictures read from them."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Iterator
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.checks import MAX_COORDINATE
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError
from mars2d.core.scene import LARGEST_IMAGE, rgb

__all__ = [
    "Bounds",
    "Picture",
    "Pixels",
    "image_bounds",
    "image_file",
    "opened_image",
    "read_picture",
]

Pixels = NDArray[np.uint8]
Bounds = tuple[float, float, float, float]
"""The place of an image: (xmin, xmax, ymin, ymax), metres."""


def image_file(name: str, value: object) -> str | None:
    """Check the name of a PNG file, or None."""
    if value is None:
        return None
    if not isinstance(value, (str, os.PathLike)) or Path(value).suffix.lower() != ".png":
        raise wrong(name, value, "the name of a file that ends in .png, or None")
    return str(value)


def image_bounds(name: str, value: object) -> Bounds | None:
    """Check the bounds of an image, or None."""
    expected = "(xmin, xmax, ymin, ymax) in metres with xmin < xmax and ymin < ymax, or None"
    if value is None:
        return None
    if isinstance(value, (tuple, list, np.ndarray)) and len(value) == 4:
        xmin, xmax, ymin, ymax = (real(f"{name}[{i}]", item) for i, item in enumerate(value))
        far = max(map(abs, (xmin, xmax, ymin, ymax))) > MAX_COORDINATE
        if xmin < xmax and ymin < ymax and not far:
            return xmin, xmax, ymin, ymax
    raise wrong(name, value, expected)


class Picture:
    """Pixels (rows, columns, 3) that all copies of a part share; the array is read-only."""

    def __init__(self, pixels: Pixels) -> None:
        """Take the pixels."""
        pixels.flags.writeable = False
        self.pixels = pixels

    def __deepcopy__(self, memo: object) -> Picture:
        return self

    @cached_property
    def darkness(self) -> NDArray[np.float64]:
        """The darkness of each pixel (rows, columns) by Rec. 601 luma: 1 is black, 0 is white."""
        luma = self.pixels @ np.array([299, 587, 114])
        dark = (255_000 - luma) / 255_000
        dark.flags.writeable = False
        return np.asarray(dark)


def read_picture(name: str, image: str, color: str | None = None) -> Picture:
    """Return the picture in a PNG file; its transparent parts show `color`, or white.

    The file is read again only if it has changed. Raises InputError, beginning with `name`, if the
    file is missing, is not a PNG with 8 bits per channel, or is too large.
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
    """Return a key that identifies a file and its present version."""
    try:
        known = path.stat()
        return str(path.absolute()), known.st_mtime_ns, known.st_size
    except (OSError, ValueError):  # reading the file fails as well, with a message
        return "", 0, 0


@lru_cache(maxsize=4)
def _read(name: str, path: Path, version: tuple[str, int, int], color: str | None) -> Picture:  # noqa: ARG001
    """Return an image laid over a colour; `version` is part of the cache's key."""
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


@contextlib.contextmanager
def opened_image(name: str, path: Path, kind: str) -> Iterator[Any]:
    """Open an image with 8 bits per channel as an image of Pillow, whose pixels are not read yet.

    kind: Pillow's name of the file's format, such as ``PNG``. Raises FileNotFoundError if the file
    is missing. Raises InputError, beginning with `name`, for anything else wrong with it, also
    while its pixels are read within the block.
    """
    from PIL import Image, UnidentifiedImageError

    what = path.suffix[1:].upper()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about sizes, which are checked here
            with Image.open(path, formats=[kind]) as image:
                _check(name, image.size, image.mode)
                yield image
    except (InputError, FileNotFoundError):
        raise
    except UnidentifiedImageError:
        raise InputError(f"{name}: this is no {what} image") from None
    except Image.DecompressionBombError:
        most = f"{LARGEST_IMAGE} x {LARGEST_IMAGE}"
        raise InputError(f"{name}: far more than {most} pixels") from None
    except Exception as error:  # Pillow raises many kinds of errors
        said = " ".join(str(error).split())[:100] or type(error).__name__
        raise InputError(f"{name}: can't be read as a {what} image: {said}") from error


def _check(name: str, size: tuple[int, int], mode: str) -> None:
    """Raise InputError if an image has too many pixels or too many bits per channel."""
    width, height = size
    if max(width, height) > LARGEST_IMAGE:
        most = f"{LARGEST_IMAGE} x {LARGEST_IMAGE}"
        raise InputError(f"{name}: {width} x {height} pixels; expected at most {most}")
    if mode.startswith(("I", "F")):
        raise InputError(f"{name}: more than 8 bits a channel; save it with 8")
