"""MAT-files of level 5, which Matlab and Octave write by ``save -v7``: read within limits.

scipy's reader takes as much memory as a file claims to need: 8 GB for a cell array in 256 bytes.
Here arrays are views of bytes that are there.

Source: MAT-File Format (The MathWorks, R2015b), chapter 1.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from mars2d.core.errors import InputError
from mars2d.output.formats.guard import check_size

__all__ = ["read_struct"]

HEAD_SIZE = 128
"""The length of a file's head, bytes: a sentence, the version, the byte order."""

MATRIX, COMPRESSED = 14, 15

STRUCT, CHAR, NUMBERS = 2, 4, range(6, 16)
"""The classes of arrays that are read; cells, objects, sparse arrays and functions are not."""

COMPLEX = 0x08

KINDS = {1: "<i1", 2: "<u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 9: "<f8",
         12: "<i8", 13: "<u8"}  # fmt: skip
"""The types in which numbers are stored, which may be shorter than the array's class."""

ENCODINGS = {4: "utf-16-le", 17: "utf-16-le", 18: "utf-32-le"}
"""The encodings of texts by their type; all others are UTF-8."""


def read_struct(path: Path, name: str, largest: int) -> dict[str, Any]:
    """Return the struct of a name in a file: arrays, text and structs by the names of its fields.

    Fields of other classes are None. Raises InputError for other formats of Matlab and Octave and
    for more than `largest` bytes, and various exceptions for a damaged file.
    """
    check_size(path, path.stat().st_size, largest)
    content = memoryview(path.read_bytes())
    _check_head(bytes(content[:HEAD_SIZE]))
    at = HEAD_SIZE
    while at < len(content):
        kind, data, at = _element(content, at, padded=False)
        if kind == COMPRESSED:
            kind, data = _expanded(path, data, largest)
        found, value = _array(data) if kind == MATRIX else ("", None)
        if found == name and isinstance(value, dict):
            return value
    raise InputError(f"{path}: holds no struct {name!r}, as records of MARS2D do")


def _check_head(head: bytes) -> None:
    if b"MATLAB 7.3" in head or head.startswith(b"\x89HDF"):
        raise InputError("a Matlab file of version 7.3; expected one of 'save -v7'")
    if head.startswith((b"# Created by Octave", b"Octave-1")):
        raise InputError("a file of Octave's own format; expected one of 'save -v7'")
    if head[124:128] != b"\x00\x01IM":
        raise ValueError("no MAT-file of level 5, little end first")


def _expanded(path: Path, data: memoryview, largest: int) -> tuple[int, memoryview]:
    """Return the element in a compressed one. Raises ValueError if its size isn't as stated."""
    stream = zlib.decompressobj()
    kind, size = struct.unpack("<II", stream.decompress(data, 8))
    check_size(path, size, largest)
    inside = stream.decompress(stream.unconsumed_tail, size + 1)
    if len(inside) != size or not stream.eof:
        raise ValueError("compressed data")
    return kind, memoryview(inside)


def _element(data: memoryview, at: int, padded: bool = True) -> tuple[int, memoryview, int]:
    """Return the kind of the element at a place, its bytes, and the place of the next one."""
    (kind,) = struct.unpack_from("<I", data, at)
    if kind >> 16:  # a small element: the upper half is its size
        kind, size, start, end = kind & 0xFFFF, kind >> 16, at + 4, at + 8
    else:
        (size,) = struct.unpack_from("<I", data, at + 4)
        start = at + 8
        end = start + size + (-size % 8 if padded else 0)
    inside = data[start : start + size]
    if len(inside) != size or start + size > end:
        raise ValueError("an element is cut off")
    return kind, inside, end


def _elements(data: memoryview) -> Iterator[tuple[int, memoryview]]:
    at = 0
    while at < len(data):
        kind, inside, at = _element(data, at)
        yield kind, inside


def _array(data: memoryview) -> tuple[str, Any]:
    """Return the name and the value of an array; the value is None if its class is not read."""
    if not len(data):
        return "", np.empty((0, 0))
    parts = _elements(data)
    flags = next(parts)[1]
    shape = tuple(np.frombuffer(next(parts)[1], "<i4").tolist())
    name = bytes(next(parts)[1]).decode()
    if flags[0] == STRUCT and prod(shape) == 1:
        return name, _fields(parts)
    if flags[0] == CHAR:
        kind, text = next(parts, (0, b""))
        return name, bytes(text).decode(ENCODINGS.get(kind, "utf-8"), "replace")
    if flags[0] in NUMBERS and not flags[1] & COMPLEX:
        kind, values = next(parts)
        return name, np.frombuffer(values, KINDS[kind]).reshape(shape, order="F")
    return name, None


def _fields(parts: Iterator[tuple[int, memoryview]]) -> dict[str, Any]:
    (width,) = struct.unpack("<i", next(parts)[1])
    names = bytes(next(parts)[1])
    if width < 1:
        raise ValueError("names of fields")
    keys = [names[i : i + width].split(b"\0")[0].decode() for i in range(0, len(names), width)]
    return {key: _array(next(parts)[1])[1] for key in keys}
