"""Reading files that may be damaged or huge: one limit of size, and one-line errors."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mars2d.core.errors import InputError, Mars2dError


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn every error that is raised while a file is read into one line that names the file."""
    try:
        yield
    except Mars2dError as error:
        if str(path) in str(error):
            raise
        raise InputError(f"{path}: {error}") from error
    except MemoryError as error:
        raise InputError(f"{path}: there is not enough memory to read it") from error
    except OSError as error:
        raise InputError(f"{path}: can't be read: {error.strerror or error}") from error
    except Exception as error:  # zip, zlib, numpy, json and mcap raise their own
        raise InputError(f"{path}: not a record of MARS2D, or damaged") from error


def check_size(path: Path, size: int, largest: int) -> None:
    """Raise InputError for a file whose data are, or claim to be, larger than the limit."""
    if size > largest:
        enough = 10 ** max(0, len(str(size)) - 2)
        enough *= -(-size // enough)  # rounded up to two digits
        raise InputError(
            f"{path}: holds, or claims to hold, {size:,} bytes of data, more than the "
            f"{largest:,} bytes that are read unless asked for: "
            f'mars2d.load("{path.name}", largest={enough:.2g})'
        )
