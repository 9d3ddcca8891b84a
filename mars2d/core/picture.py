"""Image files, opened within limits, and the pictures read from them."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arrays import locked
from mars2d.core.checks import MAX_COORDINATE, several
from mars2d.core.description import accepts, wrong
from mars2d.core.errors import InputError
from mars2d.core.scene import LARGEST_IMAGE, rgb

Pixels = NDArray[np.uint8]
Bounds = tuple[float, float, float, float]
"""The place of an image: (xmin, xmax, ymin, ymax), metres."""


@accepts({"type": "string"})
def image_file(name: str, value: object) -> str:
    """Check the name of a PNG file."""
    if not isinstance(value, (str, os.PathLike)) or Path(value).suffix.lower() != ".png":
        raise wrong(name, value, "the name of a file that ends in .png, or None")
    return str(value)


_BOUNDS = "(xmin, xmax, ymin, ymax) in metres with xmin < xmax and ymin < ymax, or None"
_four = several(-MAX_COORDINATE, MAX_COORDINATE, 4, _BOUNDS)


@accepts(vars(_four)["schema"])
def image_bounds(name: str, value: object) -> Bounds:
    """Check the bounds of an image."""
    xmin, xmax, ymin, ymax = _four(name, value)
    if xmin < xmax and ymin < ymax:
        return xmin, xmax, ymin, ymax
    raise wrong(name, value, _BOUNDS)


def read_picture(name: str, image: str, color: str | None = None) -> Pixels:
    """Return the pixels (rows, columns, 3) of a PNG file, read-only; where clear, `color` or white.

    The file is read again only if it has changed. Raises InputError, beginning with `name`, if the
    file is missing, is not a PNG with 8 bits per channel, or is too large.
    """
    path = Path(image)
    return _read(name, path, path.stat().st_mtime_ns if path.exists() else 0, color)


@lru_cache(maxsize=4)
def _read(name: str, path: Path, version: int, color: str | None) -> Pixels:  # noqa: ARG001
    """Return an image laid over a colour; `version` is part of the cache's key."""
    name = f"{name} = {str(path)!r}"
    try:
        with opened_image(name, path, "PNG") as opened:
            pixels = np.asarray(opened.convert("RGBA"))
    except FileNotFoundError:
        where = "" if path.is_absolute() else f" in {Path.cwd()}"
        beside = f"Path(__file__).with_name({path.name!r})"
        raise InputError(
            f"{name}: there is no such file{where}; beside the experiment it is {beside}"
        ) from None
    result = pixels[..., :3].copy()
    clear = pixels[..., 3] < 255
    if clear.any():
        share = pixels[clear][:, 3:] / 255
        beneath = 255 * np.array(rgb(color or "#ffffff"))
        result[clear] = np.round(result[clear] * share + beneath * (1 - share))
    return locked(result)


@contextlib.contextmanager
def opened_image(name: str, file: Path, kind: str, *, deep: bool = False) -> Iterator[Any]:
    """Open an image with 8 bits per channel as an image of Pillow, whose pixels are not read yet.

    kind: Pillow's name of its format, such as ``PNG``. deep: 16 bits of grey are allowed as well,
    in the modes ``I;16`` and ``I``. Raises FileNotFoundError if the file is missing, and
    InputError, beginning with `name`, for anything else wrong with it, also while its pixels are
    read within the block.
    """
    from PIL import Image, UnidentifiedImageError

    what = file.suffix[1:].upper()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about sizes, which are checked here
            with Image.open(file, formats=[kind]) as image:
                _check(name, *image.size, "L" if deep and image.mode[0] == "I" else image.mode)
                yield image
    except (InputError, FileNotFoundError):
        raise
    except UnidentifiedImageError:
        raise InputError(f"{name}: this is no {what} image") from None
    except Exception as error:  # Pillow raises many kinds of errors
        raise InputError(f"{name}: can't be read as a {what} image: {error}") from error


def _check(name: str, width: int, height: int, mode: str) -> None:
    if max(width, height) > LARGEST_IMAGE:
        most = f"{LARGEST_IMAGE} x {LARGEST_IMAGE}"
        raise InputError(f"{name}: {width} x {height} pixels; expected at most {most}")
    if mode.startswith(("I", "F")):
        raise InputError(f"{name}: more than 8 bits a channel; save it with 8")
