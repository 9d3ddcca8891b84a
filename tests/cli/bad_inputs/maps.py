"""Files that are no maps, or broken ones, and maps that are read in a wrong way."""

from __future__ import annotations

import io
import json
import struct
import zlib

from tests.cli.bad_inputs.case import Case, Content, experiment, typed

GARBAGE = bytes((53 * k * k + 5 * k + k // 7) % 256 for k in range(3000))

SUFFIXES = (".dxf", ".svg", ".yaml", ".geojson", ".wkt", ".png", ".pgm")

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 4 4">{}</svg>'
LINE = SVG.format('<path d="M 1 1 H 3" stroke="black"/>')

GRID = """\
image: a.pgm
resolution: 0.1
origin: [0, 0, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.2
"""
CELLS = b"P5 2 2 255\n\0\xff\xff\0"


def _dxf(*pairs: tuple[int, str]) -> str:
    rows = [(0, "SECTION"), (2, "ENTITIES"), *pairs, (0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code}\n{value}\n" for code, value in rows)


def _png(width: int, height: int) -> bytes:
    """Return a picture that claims a size and has no pixels."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        check = struct.pack(">I", zlib.crc32(kind + data))
        return struct.pack(">I", len(data)) + kind + data + check

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b"")


def _picture() -> bytes:
    from PIL import Image

    out = io.BytesIO()
    image = Image.new("L", (4, 4), 255)
    image.putpixel((1, 1), 0)
    image.save(out, "png")
    return out.getvalue()


def _geo(geometry: object) -> str:
    return json.dumps({"type": "Feature", "properties": {}, "geometry": geometry})


FILES: list[tuple[str, str, Content, tuple[str, ...]]] = [
    ("a drawing of nothing", "a.dxf", _dxf(), ("there are none",)),
    ("a drawing without its end", "a.dxf", "0\nSECTION\n2\nENTITIES\n0\nLINE\n10\n", ("a.dxf",)),
    ("an SVG of another kind", "a.svg", "<html></html>", ("a.svg",)),
    ("a grid without an image", "a.yaml", "resolution: 0.1\n", ("image",)),
    ("a grid of a word", "a.yaml", GRID.replace("0.1", "fine"), ("resolution", "fine")),
    ("a grid of a list", "a.yaml", "- 1\n- 2\n", ("a.yaml",)),
    ("a grey map cut off", "a.pgm", b"P5 100 100 255\n\0\0", ("a.pgm",)),
    ("a geometry of words", "a.geojson",
     _geo({"type": "LineString", "coordinates": [["a", 0], [1, 1]]}), ("a.geojson",)),
    ("other data as JSON", "a.json", '{"x": 1}', ("a.json",)),
    ("words cut off", "a.wkt", "LINESTRING (0 0, 20", ("a.wkt",)),
    ("words of no end", "a.wkt", "LINESTRING (0 0, inf 1)", ("a.wkt",)),
]  # fmt: skip

SETTINGS = [
    ("a layer that is none", "layers=wals", "wals"),
    ("a unit of 0", "unit=0", "unit = 0"),
    ("a tolerance below 0", "tolerance=-1", "tolerance = -1"),
    ("a place of one number", "at=5", "at = 5"),
    ("a reading without a value", "unit", "NAME=VALUE"),
]

PICTURES = [
    ("a picture that claims a terabyte", _png(10**6, 10**6), "a.png"),
    ("a picture without pixels", _png(20, 20), "a.png"),
]

IN_CODE = [
    ("a map that is a number", "Map.from_file(5)", "5"),
    ("a map read with a misspelt word", "Map.from_file('a.svg', unti='m')", "unti"),
    ("a map of points alone", "Map([(1, 1), (2, 2)])", "Map.outlines = [(1, 1), (2, 2)]"),
    ("a map's friction below 0", "Map([], friction=-1)", "Map.friction = -1", ">= 0"),
    ("an outline of no area", "Map([[(1, 1), (2, 1), (3, 1)]])", "Map.outlines[0]"),
]


def _checked(name: str, file: str, content: Content, words: tuple[str, ...]) -> Case:
    return Case(
        name,
        f"mars2d check {file}",
        (file, *words),
        {file: content, "a.pgm": CELLS} | {file: content},
    )


CASES = [
    *(_checked(f"a map {suffix} {what}", f"a{suffix}", content, ())
      for suffix in SUFFIXES for what, content in (("empty", b""), ("of garbage", GARBAGE))),
    *(_checked(*row) for row in FILES),
    *(typed(name, f"mars2d check a.svg --set {setting}", *words, a__svg=LINE)
      for name, setting, *words in SETTINGS),
    *(typed(name, "mars2d check a.png --set resolution=0.1", "a.png", *words, a__png=data)
      for name, data, *words in PICTURES),
    *(experiment(name, f"scenario = Scenario(addons=[{code}])", "line 8", *words)
      for name, code, *words in IN_CODE),
    typed("a map in a robot's way", "mars2d run random_walk --headless --set map=a.svg",
          "robot0", "inside",
          a__svg=SVG.format('<rect x="0" y="0" width="4" height="4" fill="black"/>')),
    typed("a map's figure of no format", "mars2d check a.svg --figure a.txt", "a.txt", ".png",
          a__svg=LINE),
    typed("a set map's unit that is none", "mars2d run random_walk --headless --set map=a.svg "
          "--set map.unit=mtr", "mtr", a__svg=LINE),
]  # fmt: skip
