"""How much is read: a file that claims more is refused before memory is taken."""

from __future__ import annotations

from pathlib import Path

from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError

__all__ = ["LARGEST", "MOST", "check_limit", "check_size", "in_bytes"]

LARGEST = 2**31
"""The most data that are read unless more is asked for, bytes."""

MOST = 2**62
"""The highest limit that can be asked for, bytes."""


def check_limit(largest: float) -> int:
    """Return a limit in bytes; InputError for anything that is none."""
    if not 1 <= real("largest", largest, "a number of bytes") <= MOST:
        raise wrong("largest", largest, "a number of bytes, from 1 on")
    return int(largest)


def check_size(path: Path, size: int, largest: int) -> None:
    """Refuse a file whose data are, or are said to be, larger than the limit."""
    if size > largest:
        enough = 10 ** max(0, len(str(size)) - 2)
        enough *= -(-size // enough)  # rounded up to two digits
        raise InputError(
            f"{path}: holds, or claims to hold, {in_bytes(size)} of data, more than the "
            f"{in_bytes(largest)} that are read unless asked for: "
            f'mars2d.load("{path.name}", largest={enough:.2g})'
        )


def in_bytes(size: float) -> str:
    """Return a size in words, as ``3.2 MB``.

    >>> in_bytes(3_210_000)
    '3.2 MB'
    """
    for unit in ("bytes", "kB", "MB", "GB", "TB"):
        if size < 1000 or unit == "TB":
            break
        size /= 1000
    return f"{size:,.0f} {unit}" if unit == "bytes" or size >= 100 else f"{size:.2g} {unit}"
