"""Texts and metadata as MCAP writes them."""

from __future__ import annotations

import struct

__all__ = ["metadata", "text"]


def text(data: bytes, at: int) -> tuple[str, int]:
    """Return a text and where it ends. Raises ValueError or struct.error where there is none."""
    (size,) = struct.unpack_from("<I", data, at)
    end = at + 4 + size
    if end > len(data):
        raise ValueError("a text that ends after its operation")
    return data[at + 4 : end].decode(), end


def metadata(data: bytes) -> tuple[str, dict[str, str]]:
    """Return the name of metadata and what they say."""
    name, at = text(data, 0)
    (size,) = struct.unpack_from("<I", data, at)
    at += 4
    end, told = at + size, {}
    while at < end:
        key, at = text(data, at)
        told[key], at = text(data, at)
    return name, told
