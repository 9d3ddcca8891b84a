"""Files that appear under their name when they are complete."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from mars2d.core.errors import InputError

__all__ = ["replacing"]


@contextmanager
def replacing(target: Path) -> Iterator[BinaryIO]:
    """Open a file beside `target` that takes its place once all has been written.

    Where that fails, what was there before stays as it was. Raises InputError where nothing can be
    written, as on a full disk.
    """
    if target.is_dir():
        raise InputError(f"{target}: can't be written: this is a folder")
    if target.exists() and not os.access(target, os.W_OK):
        raise InputError(f"{target}: can't be written: it may only be read")
    part = target.with_name(f".{target.name}.part")
    try:
        try:
            with part.open("w+b") as file:
                yield file
            part.replace(target)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{target}: can't be written: {error.strerror or error}") from error
