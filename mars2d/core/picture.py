"""Image files, opened within limits, and the pictures read from them."""

from __future__ import annotations

import contextlib
import os
import warnings
from base64 import b64decode, b64encode
from collections.abc import Iterator
from functools import lru_cache
from io import BytesIO
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


INSIDE, DATA = "data:image/png;name=", ";base64,"
"""What a picture that is in a record has before its name, and between its name and itself."""


def holds_pixels(image: str) -> bool:
    """Return whether a text is a picture itself, not the name of its file."""
    return image.startswith(INSIDE) and DATA in image


def without_pixels(image: str) -> str:
    """Return the text of a picture that is not there."""
    return f"{INSIDE}{picture_name(image)}{DATA}"


def picture_name(image: str) -> str:
    """Return the name of a picture's file without its folder, also of one that is in a record."""
    if holds_pixels(image):
        image = image.removeprefix(INSIDE).rpartition(DATA)[0]
    return Path(image).name


@accepts({"type": "string"})
def image_file(name: str, value: object) -> str:
    """Check the name of a PNG file, or a picture in a record."""
    if isinstance(value, str) and holds_pixels(value):
        return value
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


def with_pixels(image: str, pixels: Pixels) -> str:
    """Return a picture as a text with the name of its file, which is read as its file is."""
    from PIL import Image

    file = BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return without_pixels(image) + b64encode(file.getvalue()).decode()


def read_picture(name: str, image: str, color: str | None = None) -> Pixels:
    """Return the pixels (rows, columns, 3) of a PNG file, read-only; where clear, `color` or white.

    The file is read again only if it has changed. Raises InputError, beginning with `name`, if the
    file is missing, is not a PNG with 8 bits per channel, or is too large. No file is opened for a
    picture in a record.
    """
    named = not holds_pixels(image) and Path(image).exists()
    return _read(name, image, Path(image).stat().st_mtime_ns if named else 0, color)


@lru_cache(maxsize=4)
def _read(name: str, image: str, version: int, color: str | None) -> Pixels:  # noqa: ARG001
    """Return an image laid over a colour; `version` is part of the cache's key."""
    name = f"{name} = {(picture_name(image) if holds_pixels(image) else image)!r}"
    try:
        with opened_image(name, _inside(name, image), "PNG") as opened:
            pixels = np.asarray(opened.convert("RGBA"))
    except FileNotFoundError:
        path = Path(image)
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


def _inside(name: str, image: str) -> Path | BytesIO:
    """Return the place of a picture: its file, or what a record holds of it."""
    if not holds_pixels(image):
        return Path(image)
    data = image.rpartition(DATA)[2]
    if not data:
        raise InputError(f"{name}: the record does not hold this picture")
    try:
        return BytesIO(b64decode(data, validate=True))
    except ValueError:
        raise InputError(f"{name}: this is no PNG image") from None


@contextlib.contextmanager
def opened_image(
    name: str, file: Path | BytesIO, kind: str, *, deep: bool = False
) -> Iterator[Any]:
    """Open an image with 8 bits per channel as an image of Pillow, whose pixels are not read yet.

    file: its path, or what is in it. kind: Pillow's name of its format, such as ``PNG``. deep: 16
    bits of grey are allowed as well, in the modes ``I;16`` and ``I``. Raises
    FileNotFoundError if the file is missing. Raises InputError, beginning with `name`, for anything
    else wrong with it, also while its pixels are read within the block.
    """
    from PIL import Image, UnidentifiedImageError

    what = file.suffix[1:].upper() if isinstance(file, Path) else kind
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
