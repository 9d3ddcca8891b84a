"""Protocol Buffers on the wire: as much of it as rows need.

Packed numbers are an array's own bytes, so none of them is changed, nor made an object of Python.
Source: Protocol Buffers Documentation, Encoding.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["block", "fields", "packed", "unpacked", "varint"]

VARINT, DOUBLE, BLOCK, FIXED32 = 0, 1, 2, 5

_KINDS = {kind[-2]: np.dtype(kind) for kind in ("<f8", "<i4", "<u4")} | {"b": np.dtype("?")}


def varint(number: int) -> bytes:
    """Return a whole number >= 0 in pieces of seven bits.

    >>> varint(300).hex()
    'ac02'
    """
    pieces = bytearray()
    while number > 0x7F:
        pieces.append(number & 0x7F | 0x80)
        number >>= 7
    pieces.append(number)
    return bytes(pieces)


def block(field: int, data: bytes) -> bytes:
    """Return a field that holds bytes: text, a message, packed numbers. field: 1 to 15."""
    size = len(data)
    head = (field << 3 | BLOCK, size) if size < 0x80 else (field << 3 | BLOCK, *varint(size))
    return bytes(head) + data


def packed(field: int, values: NDArray[Any]) -> bytes:
    """Return a field that holds an array's numbers: double, sfixed32, fixed32 or bool."""
    dtype = _KINDS[values.dtype.kind]
    return block(field, (values if values.dtype is dtype else values.astype(dtype)).tobytes())


def unpacked(data: memoryview, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Return the numbers of a field that `packed` made of an array of this kind."""
    return np.frombuffer(data, dtype=_KINDS[dtype.kind]).astype(dtype, copy=False)


def fields(data: memoryview) -> Iterator[tuple[int, memoryview | int]]:
    """Yield the fields of a message: their numbers, and their bytes or whole numbers.

    Raises ValueError or IndexError where that is no message.
    """
    at = 0
    while at < len(data):
        field, kind = data[at] >> 3, data[at] & 7
        at += 1
        if kind in (VARINT, BLOCK):
            size, at = _varint(data, at)
            if kind == VARINT:
                yield field, size
                continue
        else:
            size = {DOUBLE: 8, FIXED32: 4}[kind]
        if size > len(data) - at:
            raise ValueError("a field that ends after its message")
        yield field, data[at : at + size]
        at += size


def _varint(data: memoryview, at: int) -> tuple[int, int]:
    """Return a whole number and where it ends."""
    number = shift = 0
    while True:
        piece = data[at]
        at += 1
        number |= (piece & 0x7F) << shift
        if piece < 0x80:
            return number, at
        shift += 7
        if shift > 63:
            raise ValueError("a number of more than 64 bits")
