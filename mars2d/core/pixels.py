"""Image files, opened within limits: what is wrong with one is said, and harms nobody."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError

__all__ = ["LARGEST_IMAGE", "opened_image"]

LARGEST_IMAGE = 4096
"""Rows and columns of an image, at most."""


@contextlib.contextmanager
def opened_image(name: str, path: Path, kind: str) -> Iterator[Any]:
    """Open an image of 8 bits a channel; give it as Pillow has it, its pixels not read yet.

    kind: what Pillow calls the file's format, as ``PNG``. Raises InputError, beginning with `name`,
    for anything wrong with the file, also while its pixels are read within the context; for a
    missing file FileNotFoundError.
    """
    from PIL import Image, UnidentifiedImageError

    what = path.suffix[1:].upper()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of sizes, which are looked at here
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
    except Exception as error:  # Pillow raises whatever comes
        said = " ".join(str(error).split())[:100] or type(error).__name__
        raise InputError(f"{name}: can't be read as a {what} image: {said}") from error


def _check(name: str, size: tuple[int, int], mode: str) -> None:
    """Refuse an image that is too large, or too fine, before its pixels are read."""
    width, height = size
    if max(width, height) > LARGEST_IMAGE:
        most = f"{LARGEST_IMAGE} x {LARGEST_IMAGE}"
        raise InputError(f"{name}: {width} x {height} pixels; expected at most {most}")
    if mode.startswith(("I", "F")):
        raise InputError(f"{name}: more than 8 bits a channel; save it with 8")
