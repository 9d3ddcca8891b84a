"""Files of netCDF 3, classic and with 64-bit offsets: read within limits.

Nothing is taken for granted of what a file claims: variables are views of bytes that are there.
Source: NetCDF Users Guide, appendix "File Format Specifications" (Unidata).
"""

from __future__ import annotations

import struct
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import InputError

__all__ = ["read_netcdf"]

KINDS = {1: ">i1", 2: "S1", 3: ">i2", 4: ">i4", 5: ">f4", 6: ">f8"}

TEXT = 2

DIMENSION, VARIABLE, ATTRIBUTE = 10, 11, 12


def read_netcdf(content: memoryview) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Return a file's global attributes and its variables, by name.

    Texts are str, all else arrays. Raises InputError for netCDF 4, and whatever comes up in a
    damaged file.
    """
    magic = bytes(content[:4])
    if magic == b"\x89HDF":
        raise InputError("netCDF 4 (HDF5); expected netCDF 3: 'nccopy -k nc6' makes it of this")
    if magic not in (b"CDF\x01", b"CDF\x02"):
        raise ValueError("no netCDF 3")
    head = _Head(content, 8, ">I" if magic[3] == 1 else ">Q")
    sizes = [(head.text(), head.number()) for _ in head.listing(DIMENSION)]
    attributes = head.attributes()
    variables = {}
    for _ in head.listing(VARIABLE):
        name, rank = head.text(), head.number()
        shape = tuple(sizes[head.number()][1] for _ in range(rank))
        head.attributes()
        kind = np.dtype(KINDS[head.number()])
        head.number()  # its size, which may be too large to be right
        (start,) = head.unpack(head.offset)
        if 0 in shape:  # along a dimension that grows; records have none
            continue
        variables[name] = np.frombuffer(content, kind, prod(shape), start).reshape(shape)
    return attributes, variables


class _Head:
    """The head of a file, read from front to back."""

    def __init__(self, content: memoryview, at: int, offset: str) -> None:
        self.content, self.at, self.offset = content, at, offset

    def unpack(self, form: str) -> tuple[Any, ...]:
        found = struct.unpack_from(form, self.content, self.at)
        self.at += struct.calcsize(form)
        return found

    def number(self) -> int:
        return int(self.unpack(">I")[0])

    def take(self, size: int) -> memoryview:
        """Return the next bytes, which are filled up to a multiple of 4."""
        found = self.content[self.at : self.at + size]
        if len(found) != size:
            raise ValueError("cut off")
        self.at += size + -size % 4
        return found

    def text(self) -> str:
        return bytes(self.take(self.number())).decode()

    def listing(self, kind: int) -> range:
        found, count = self.unpack(">II")
        if found not in (0, kind) or (not found and count):
            raise ValueError("a list")
        return range(count)

    def attributes(self) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for _ in self.listing(ATTRIBUTE):
            name, kind, count = self.text(), self.number(), self.number()
            values = self.take(count * np.dtype(KINDS[kind]).itemsize)
            text = kind == TEXT
            found[name] = bytes(values).decode() if text else np.frombuffer(values, KINDS[kind])
        return found
