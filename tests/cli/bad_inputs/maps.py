"""Files that are no maps, or broken ones, and maps that are read in a wrong way."""

from __future__ import annotations

import struct
import zlib

from tests.cli.bad_inputs.case import experiment, typed

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 4 4">{}</svg>'
LINE = SVG.format('<path d="M 1 1 H 3" stroke="black"/>')


def _png(width: int, height: int) -> bytes:
    """Return a picture that claims a size and has no pixels."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        check = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + check

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")


SETTINGS = [
    ("a layer that is none", "layers=wals", "wals"),
    ("a unit of 0", "unit=0", "unit = 0"),
    ("a tolerance below 0", "tolerance=-1", "tolerance = -1"),
    ("a place of one number", "at=5", "at = 5"),
    ("a reading without a value", "unit", "NAME=VALUE"),
]

IN_CODE = [
    ("a map that is a number", "Map.from_file(5)", "5"),
    ("a map read with a misspelt word", "Map.from_file('a.svg', unti='m')", "unti"),
    ("a map of points alone", "Map([(1, 1), (2, 2)])", "Map.outlines = [(1, 1), (2, 2)]"),
    ("a map's friction below 0", "Map([], friction=-1)", "Map.friction = -1", ">= 0"),
    ("an outline of no area", "Map([[(1, 1), (2, 1), (3, 1)]])", "Map.outlines[0]"),
]

CASES = [
    typed("an SVG of another kind", "mars2d check a.svg", "a.svg", a__svg="<html></html>"),
    typed("a grey map cut off", "mars2d check a.pgm --set resolution=0.1", "a.pgm",
          a__pgm=b"P5 100 100 255\n\0\0"),
    *(typed(name, f"mars2d check a.svg --set {setting}", *words, a__svg=LINE)
      for name, setting, *words in SETTINGS),
    typed("a picture that claims a terabyte", "mars2d check a.png --set resolution=0.1", "a.png",
          a__png=_png(10**6, 10**6)),
    *(experiment(name, f"scenario = Scenario(addons=[{code}])", "line 8", *words)
      for name, code, *words in IN_CODE),
]  # fmt: skip
